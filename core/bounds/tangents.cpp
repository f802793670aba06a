#include "core/bounds/tangents.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/geometry/angle.h"
#include "core/geometry/tolerance.h"

namespace fleetplan::core {
namespace {

constexpr double kPi = std::numbers::pi;
/// Rounding of the direction of a tangent that crosses between two circles that nearly touch (radians).
constexpr double kBlur = 1e-7;
/// Rounding of headings along an axis (radians): a move grazes a quarter within this of its end.
constexpr double kGrazing = 1e-12;
/// An arc is tested in so many pieces, few enough for the bits of a number; each is then within 0.12 % of the
/// radius from its chord.
constexpr int kPieces = 16;
constexpr double kPiece = 0.5 * kPi / kPieces;

/// Work for a tangent that is computed, and for a sweep that is tested against obstacles; so many corners
/// that prove to lie the wrong way are a step of work. Measured.
constexpr int kTangentWork = 3;
constexpr int kGlances = 4;
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

/// How far from its own a component of the vector `d` between two centres may be between the places where a
/// tangent touches their circles, `across` being how much farther to its left the second centre is.
double slack(const Position& d, double across) {
  return across + kBlur * (std::abs(d.x()) + std::abs(d.y()));
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

const Tangents::Quadrant& Tangents::quadrant(const Corner& corner, bool left) {
  static constexpr std::array<Quadrant, 4> kQuadrants = {Quadrant{-1.0, -1.0, -0.75 * kPi},
                                                         {1.0, -1.0, -0.25 * kPi},
                                                         {-1.0, 1.0, 0.75 * kPi},
                                                         {1.0, 1.0, 0.25 * kPi}};
  // With the corner on the left, the way away from the blocked cell is to the right.
  const bool east = left ? corner.away_y < 0 : corner.away_y > 0;
  const bool north = left ? corner.away_x > 0 : corner.away_x < 0;
  return kQuadrants[(north ? 2U : 0U) + (east ? 1U : 0U)];
}

Tangents::Side Tangents::side(const Bend& bend) const {
  return {corners_.position(bend.corner), bend.left ? radius_ : -radius_,
          &quadrant(corners_.corner(bend.corner), bend.left)};
}

/// Has a disk that moves along this vector a heading that it can have on the bend? To within `slack`, of the
/// vector's unit.
bool Tangents::may_head(const Side& side, const Position& direction, double slack) {
  return side.quadrant == nullptr ||
         (direction.x() * side.quadrant->x >= -slack && direction.y() * side.quadrant->y >= -slack);
}

/// Where a move of this heading touches the circle of `side`.
double Tangents::place(const Side& side, double heading) {
  if (side.quadrant == nullptr) return 0.0;
  const double turned = rotation_between(side.quadrant->middle, heading);
  return side.offset > 0.0 ? turned : -turned;
}

std::optional<Tangent> Tangents::tangent(const Side& from, const Side& to) {
  ++work_;
  const Position d = to.center - from.center;
  const double across = to.offset - from.offset;
  const double most = slack(d, std::abs(across));
  if (!may_head(from, d, most) || !may_head(to, d, most)) return std::nullopt;
  work_ += kTangentWork;
  const double distance = d.norm();
  if (!(distance > std::abs(across))) return std::nullopt;
  const double sine = across / distance;
  const double cosine = std::sqrt(1.0 - sine * sine);
  const Position along = Position(d.x() * cosine + d.y() * sine, d.y() * cosine - d.x() * sine) / distance;
  if (!may_head(from, along, kBlur) || !may_head(to, along, kBlur)) return std::nullopt;
  Tangent tangent;
  tangent.heading = std::atan2(along.y(), along.x());
  tangent.leave = place(from, tangent.heading);
  tangent.arrive = place(to, tangent.heading);
  const bool grazes_first = std::abs(tangent.leave + 0.25 * kPi) < kGrazing;
  const bool grazes_last = std::abs(tangent.arrive - 0.25 * kPi) < kGrazing;
  if (grazes_first || grazes_last) return std::nullopt;
  tangent.length = distance * cosine;
  const Position left(-along.y(), along.x());
  tangent.begin = from.center - from.offset * left;
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
  return sight_.may_sweep(tangent.begin, tangent.end, radius_ - kShrink) && !squeezes_through(tangent);
}

bool Tangents::squeezes_through(const Tangent& tangent) const {
  if (tight_gap_ == 0) return false;
  const Position d = tangent.end - tangent.begin;
  const int axis = std::abs(d.y()) > std::abs(d.x()) ? 1 : 0;
  if (std::abs(d[1 - axis]) > kOnLine * tangent.length) return false;
  const Position begin = tangent.begin / corners_.grid().resolution();
  const Position end = tangent.end / corners_.grid().resolution();
  const double line = std::round(end[1 - axis]);
  if (std::abs(end[1 - axis] - line) > kOnLine) return false;
  const auto [low, high] = std::minmax(begin[axis], end[axis]);
  const int last = static_cast<int>(std::floor(high + kOnLine));
  for (int cell = static_cast<int>(std::ceil(low - kOnLine)); cell < last; ++cell) {
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

std::span<const Tangent> Tangents::from(const Bend& bend) {
  Links& links = from_[static_cast<std::size_t>(index(bend))];
  if (links.begin < 0) links = link(bend);
  return std::span(tangents_).subspan(static_cast<std::size_t>(links.begin),
                                      static_cast<std::size_t>(links.end - links.begin));
}

Tangents::Links Tangents::link(const Bend& bend) {
  const auto begin = static_cast<std::ptrdiff_t>(tangents_.size());
  const Side here = side(bend);
  const std::vector<int>& corners = corners_.bends_from(bend.corner);
  work_ += static_cast<std::int64_t>(corners.size()) / kGlances;
  for (const int corner : corners) {
    const Position d = corners_.position(corner) - here.center;
    if (!may_head(here, d, slack(d, 2.0 * radius_))) continue;
    for (const bool left : {false, true}) {
      const Bend to{corner, left};
      const auto found = tangent(here, side(to));
      if (!found) continue;
      tangents_.push_back(*found);
      tangents_.back().to = to;
    }
  }
  freedom_.resize(tangents_.size(), Freedom::unknown);
  std::stable_sort(tangents_.begin() + begin, tangents_.end(),
                   [](const Tangent& a, const Tangent& b) { return a.leave > b.leave; });
  return {static_cast<int>(begin), static_cast<int>(tangents_.size())};
}

bool Tangents::is_free(const Bend& bend, std::size_t k) {
  const auto link = static_cast<std::size_t>(from_[static_cast<std::size_t>(index(bend))].begin) + k;
  Freedom& freedom = freedom_[link];
  if (freedom == Freedom::unknown) freedom = is_free(tangents_[link]) ? Freedom::free : Freedom::blocked;
  return freedom == Freedom::free;
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
