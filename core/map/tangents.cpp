#include "core/map/tangents.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/geometry/tolerance.h"

namespace fleetplan::core {
namespace {

constexpr double kPi = std::numbers::pi;
/// Rounding of the direction of a tangent that crosses between two circles that nearly touch (radians).
constexpr double kBlur = 1e-7;
/// An arc is tested in so many pieces, few enough for the bits of a number; each is then within 0.12 % of the
/// radius from its chord.
constexpr int kPieces = 16;
constexpr double kPiece = 0.5 * kPi / kPieces;

/// Work for a tangent that is computed, and for a sweep that is tested against obstacles; measured.
constexpr int kTangentWork = 3;
constexpr int kSweepWork = 30;
/// A gap is tight if a straight move through a third of one cell of it stays on the grid line, up to three
/// times this, in cells, from one end of the map to the other; so both of its ends would be off all cell
/// centres. (The third: a robot may stop in the gap at its own start and goal. With both at the ends of one
/// move, the goal is in sight, and nobody asks for taut paths.)
constexpr double kOffLine = 0.1;
/// Room that contact with the walls leaves to a disk that just fits, metres.
constexpr double kPlay = 4.0 * kContactTolerance;
/// A tangent in a tight gap is so close to a grid line, in cells and radians; far more than kShrink makes of
/// it.
constexpr double kOnLine = 1e-3;

/// The width in cells of a gap that is tight for the disk, or 0.
int tight_gap(const OccupancyGrid& grid, double radius) {
  const double gap = 2.0 * radius / grid.resolution();
  if (gap > std::min(grid.columns(), grid.rows()) + 1.0) return 0;
  const int cells = static_cast<int>(std::lround(gap));
  if (cells == 0 || cells % 2 != 0) return 0;
  const double play = std::max(0.0, cells - gap) + kPlay / grid.resolution();
  return play * std::max(grid.columns(), grid.rows()) <= kOffLine ? cells : 0;
}

/// The direction away from the blocked cell.
double axis(const Corner& corner) { return std::atan2(corner.away_y, corner.away_x); }

}  // namespace

Tangents::Tangents(CornerSight& corners, const LineOfSight& sight, double radius)
    : corners_(corners),
      sight_(sight),
      radius_(radius - kShrink),
      tight_gap_(tight_gap(corners.grid(), radius)),
      from_(2 * static_cast<std::size_t>(corners.count())),
      arcs_(static_cast<std::size_t>(corners.count())) {}

Tangents::Side Tangents::side(const Bend& bend) const {
  return {corners_.position(bend.corner), bend.left ? radius_ : -radius_, &corners_.corner(bend.corner)};
}

/// Where a move with this unit vector to its left touches the circle of `side`; none outside the quarter.
std::optional<double> Tangents::place(const Side& side, const Position& left_normal) {
  if (side.corner == nullptr) return 0.0;
  const double sign = side.offset > 0.0 ? 1.0 : -1.0;
  const Position outward = -sign * left_normal;
  const double along_x = outward.x() * side.corner->away_x;
  const double along_y = outward.y() * side.corner->away_y;
  if (along_x < -kBlur || along_y < -kBlur) return std::nullopt;
  const double handed = side.corner->away_x * side.corner->away_y * sign;
  return handed * (std::atan2(along_y, along_x) - 0.25 * kPi);
}

std::optional<Tangent> Tangents::tangent(const Side& from, const Side& to) {
  work_ += kTangentWork;
  const Position d = to.center - from.center;
  const double distance = d.norm();
  const double across = to.offset - from.offset;
  if (!(distance > std::abs(across))) return std::nullopt;
  const double sine = across / distance;
  const double cosine = std::sqrt(1.0 - sine * sine);
  const Position along = Position(d.x() * cosine + d.y() * sine, d.y() * cosine - d.x() * sine) / distance;
  const Position left(-along.y(), along.x());
  const auto leave = place(from, left);
  if (!leave) return std::nullopt;
  const auto arrive = place(to, left);
  if (!arrive) return std::nullopt;
  Tangent tangent;
  tangent.leave = *leave;
  tangent.arrive = *arrive;
  tangent.length = distance * cosine;
  tangent.heading = std::atan2(along.y(), along.x());
  tangent.end = to.center - to.offset * left;
  return tangent;
}

std::optional<Tangent> Tangents::from_point(const Position& point, const Bend& to) {
  auto found = tangent(side(point), side(to));
  if (found) found->to = to;
  return found;
}

std::optional<Tangent> Tangents::to_point(const Bend& from, const Position& point) {
  return tangent(side(from), side(point));
}

bool Tangents::is_free(const Tangent& tangent) {
  work_ += kSweepWork;
  const Position along(std::cos(tangent.heading), std::sin(tangent.heading));
  return sight_.may_sweep(tangent.end - tangent.length * along, tangent.end, radius_ - kShrink) &&
         !squeezes_through(tangent, along);
}

bool Tangents::squeezes_through(const Tangent& tangent, const Position& along) const {
  if (tight_gap_ == 0 || std::min(std::abs(along.x()), std::abs(along.y())) > kOnLine) return false;
  const int axis = std::abs(along.y()) > std::abs(along.x()) ? 1 : 0;
  const Position end = tangent.end / corners_.grid().resolution();
  const double length = tangent.length / corners_.grid().resolution();
  const double line = std::round(end[1 - axis]);
  if (std::abs(end[1 - axis] - line) > kOnLine) return false;
  const double begin = end[axis] - (along[axis] > 0.0 ? length : -length);
  const int last = static_cast<int>(std::floor(std::max(begin, end[axis]) + kOnLine));
  for (int cell = static_cast<int>(std::ceil(std::min(begin, end[axis]) - kOnLine)); cell < last; ++cell) {
    if (gap_at(static_cast<int>(line), cell, axis == 1)) return true;
  }
  return false;
}

/// Are there walls on both sides of the grid line, just a tight gap apart?
bool Tangents::gap_at(int line, int cell, bool upright) const {
  const int low = line - tight_gap_ / 2 - 1;
  const int high = line + tight_gap_ / 2;
  const OccupancyGrid& grid = corners_.grid();
  return upright ? grid.blocked({low, cell}) && grid.blocked({high, cell})
                 : grid.blocked({cell, low}) && grid.blocked({cell, high});
}

const std::vector<Tangent>& Tangents::from(const Bend& bend) {
  auto& known = from_[static_cast<std::size_t>(index(bend))];
  if (known) return *known;
  known.emplace();
  for (const int corner : corners_.seen_from_corner(bend.corner)) {
    for (const bool left : {false, true}) {
      auto found = tangent(side(bend), side(Bend{corner, left}));
      if (!found || !is_free(*found)) continue;
      found->to = {corner, left};
      known->push_back(*found);
    }
  }
  std::stable_sort(known->begin(), known->end(),
                   [](const Tangent& a, const Tangent& b) { return a.leave > b.leave; });
  return *known;
}

const Tangents::Arc& Tangents::arc(int corner) {
  Arc& arc = arcs_[static_cast<std::size_t>(corner)];
  if (arc.known) return arc;
  arc.known = true;
  work_ += kPieces * kSweepWork;
  const double first = axis(corners_.corner(corner)) - 0.25 * kPi;
  const Position center = corners_.position(corner);
  const auto at = [&](int k) {
    const double angle = first + k * kPiece;
    return Position(center + radius_ * Position(std::cos(angle), std::sin(angle)));
  };
  const double off_chord = radius_ * (1.0 - std::cos(0.5 * kPiece));
  for (int k = 0; k < kPieces; ++k) {
    if (!sight_.may_sweep(at(k), at(k + 1), radius_ - off_chord - kShrink)) arc.blocked |= 1u << k;
  }
  return arc;
}

bool Tangents::may_bend(const Bend& bend, double from, double to) {
  const double low = bend.left ? from : -to;
  const double high = bend.left ? to : -from;
  const int first = std::max(0, static_cast<int>(std::ceil((low + 0.25 * kPi) / kPiece + kBlur)));
  const int last = std::min(kPieces, static_cast<int>(std::floor((high + 0.25 * kPi) / kPiece - kBlur)));
  if (last <= first) return true;
  const std::uint32_t pieces = ((1u << last) - 1u) & ~((1u << first) - 1u);
  return (arc(bend.corner).blocked & pieces) == 0;
}

}  // namespace fleetplan::core
