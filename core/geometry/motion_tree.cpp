#include "core/geometry/motion_tree.h"

#include <cmath>
#include <optional>
#include <tuple>

#include "core/runtime/arrays.h"

namespace fleetplan::core {
namespace {

/// Pieces beyond one for each motion, to bound memory and time.
constexpr double kMorePieces = 6e5;
/// Motions shorter than the map's longer side divided by this are not divided.
constexpr double kPiecesAcross = 64.0;
/// Steps of a loop between two checks of the stop condition.
constexpr std::size_t kStopStride = 1024;
/// More than what rounding of positions and times adds to a box, relative to their size.
constexpr double kBoxRounding = 1e-14;

/// Bit k of the lower 21 bits goes to bit 3 k.
std::uint64_t spread(std::uint64_t x) {
  x = (x | x << 32) & 0x001f00000000ffffULL;
  x = (x | x << 16) & 0x001f0000ff0000ffULL;
  x = (x | x << 8) & 0x100f00f00f00f00fULL;
  x = (x | x << 4) & 0x10c30c30c30c30c3ULL;
  x = (x | x << 2) & 0x1249249249249249ULL;
  return x;
}

std::uint64_t coordinate(double value, double size) {
  constexpr double kSteps = 0x1p21 - 1.0;
  return size > 0.0 ? static_cast<std::uint64_t>(kSteps * std::clamp(value / size, 0.0, 1.0)) : 0;
}

double length_of(const MovingDisk& motion) {
  const double speed = motion.velocity.norm();
  return speed > 0.0 ? speed * (motion.t_end - motion.t_start) : 0.0;
}

/// The last time at which something begins or ends.
double last_time(const std::vector<MotionTree::Disk>& disks) {
  double last = 0.0;
  for (const auto& disk : disks) {
    last = std::max(last, disk.motion.t_end < kForever ? disk.motion.t_end : disk.motion.t_start);
  }
  return last;
}

}  // namespace

MotionTree::MotionTree(std::vector<Disk> disks, const Extent& extent, const StopCondition& stop)
    : disks_(std::move(disks)) {
  std::optional<std::vector<Piece>> all = pieces(extent, stop);
  const auto before = [](const Piece& a, const Piece& b) {
    return std::tuple(a.key, a.disk, a.part) < std::tuple(b.key, b.disk, b.part);
  };
  finished_ = all && stoppable_sort(*all, before, [&](std::size_t /*pieces*/) { return stop.met(); }) &&
              build(*all, stop);
}

/// The pieces that a query can come near, not yet in order; none if the stop condition is met.
std::optional<std::vector<MotionTree::Piece>> MotionTree::pieces(const Extent& extent,
                                                                 const StopCondition& stop) const {
  double total = 0.0;
  for (const Disk& disk : disks_) total += length_of(disk.motion);
  const double length = std::max(std::max(extent.width, extent.height) / kPiecesAcross, total / kMorePieces);
  const double t_last = last_time(disks_);
  std::vector<Piece> all;
  StopStride disks = StopStride::from_first(stop, kStopStride);
  for (std::size_t i = 0; i < disks_.size(); ++i) {
    if (disks.met_at_step()) return std::nullopt;
    const auto parts = static_cast<std::uint32_t>(std::ceil(length_of(disks_[i].motion) / length));
    Piece piece{0, static_cast<std::uint32_t>(i), 0, std::max(parts, 1U)};
    StopStride parts_of_disk(stop, kStopStride);
    for (; piece.part < piece.parts; ++piece.part) {
      if (parts_of_disk.met_at_step()) return std::nullopt;
      const MotionBox b = box(piece);
      if (b.low.x() > extent.width + extent.radius || b.low.y() > extent.height + extent.radius ||
          b.high.x() < -extent.radius || b.high.y() < -extent.radius)
        continue;
      const Position centre = 0.5 * (b.low + b.high);
      const double t = b.t_end < kForever ? 0.5 * (b.t_begin + b.t_end) : t_last;
      piece.key = spread(coordinate(centre.x(), extent.width)) |
                  spread(coordinate(centre.y(), extent.height)) << 1 | spread(coordinate(t, t_last)) << 2;
      all.push_back(piece);
    }
  }
  return all;
}

MotionBox MotionTree::box(const Piece& piece) const {
  const auto& [motion, radius] = disks_[piece.disk];
  MotionBox box;
  box.t_begin = motion.t_start;
  box.t_end = motion.t_end;
  if (piece.parts > 1) {
    const double step = (motion.t_end - motion.t_start) / piece.parts;
    box.t_begin = motion.t_start + piece.part * step;
    if (piece.part + 1 < piece.parts) box.t_end = motion.t_start + (piece.part + 1) * step;
  }
  const Position from = motion.at(box.t_begin);
  const Position to = motion.velocity.squaredNorm() > 0.0 ? motion.at(box.t_end) : from;
  const Position slack = kBoxRounding * from.cwiseAbs().cwiseMax(to.cwiseAbs());
  box.low = from.cwiseMin(to).array() - radius - slack.array();
  box.high = from.cwiseMax(to).array() + radius + slack.array();
  box.t_begin -= kBoxRounding * box.t_begin;
  box.t_end += kBoxRounding * box.t_end;
  return box;
}

bool MotionTree::build(const std::vector<Piece>& pieces, const StopCondition& stop) {
  if (pieces.empty()) return true;
  leaves_.reserve(pieces.size());
  levels_.emplace_back((pieces.size() + kFanOut - 1) / kFanOut);
  StopStride stride = StopStride::from_first(stop, kStopStride);
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    if (stride.met_at_step()) return false;
    leaves_.push_back(pieces[k].disk);
    levels_[0][k / kFanOut].add(box(pieces[k]));
  }
  while (levels_.back().size() > 1) {
    const std::vector<MotionBox>& below = levels_.back();
    std::vector<MotionBox> above((below.size() + kFanOut - 1) / kFanOut);
    for (std::size_t k = 0; k < below.size(); ++k) above[k / kFanOut].add(below[k]);
    levels_.push_back(std::move(above));
  }
  return true;
}

}  // namespace fleetplan::core
