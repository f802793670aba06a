#include "core/bounds/tangent_graph.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <vector>

#include "core/geometry/elementary_functions.h"
#include "core/geometry/position.h"
#include "core/geometry/tolerance.h"

namespace fleetplan::core {
namespace {

/// The greatest deviation from the grid line, in cells, in a tight gap. A straight move in the gap stays so
/// close to the line through a third of one cell. So it deviates by up to three times this from one end of
/// the map to the other, and both of its ends are off all cell centres.
///
/// (The third: a robot may stop in the gap at its own start and goal. If both are the ends of one move, the
/// goal is in sight, and no taut path is needed.)
constexpr double kMaxDeviation = 0.1;
/// The play that contact with the walls leaves to a disk that just fits, metres.
constexpr double kPlay = 8.0 * kSearchSlack;
/// A tangent in a tight gap is so close to a grid line, in cells and radians. This is far more than the
/// reduction of the disk's radius causes.
constexpr double kOnLine = 1e-3;

/// The width in cells of a gap that is tight for the disk, or 0.
int tight_width(const OccupancyGrid& grid, double radius) {
  const double diameter = 2.0 * radius / grid.resolution();
  if (diameter > std::min(grid.columns(), grid.rows()) + 1.0) return 0;
  const int cells = static_cast<int>(std::lround(diameter));
  if (cells == 0 || cells % 2 != 0) return 0;
  const double play = std::max(0.0, cells - diameter) + kPlay / grid.resolution();
  return play * std::max(grid.columns(), grid.rows()) <= kMaxDeviation ? cells : 0;
}

}  // namespace

TightGaps::TightGaps(const OccupancyGrid& grid, double radius, bool stops_at_cell_centers)
    : grid_(grid), width_(stops_at_cell_centers ? tight_width(grid, radius) : 0) {}

bool TightGaps::crossed_by(const Position& begin, const Position& end, double length) const {
  if (width_ == 0) return false;
  const Position d = end - begin;
  const int axis = std::abs(d.y()) > std::abs(d.x()) ? 1 : 0;
  if (std::abs(d[1 - axis]) > kOnLine * length) return false;
  const Position first = begin / grid_.resolution();
  const Position last = end / grid_.resolution();
  const double line = std::round(last[1 - axis]);
  if (std::abs(last[1 - axis] - line) > kOnLine) return false;
  const auto [low, high] = std::minmax(first[axis], last[axis]);
  const int end_cell = static_cast<int>(std::floor(high + kOnLine));
  for (int cell = static_cast<int>(std::ceil(low - kOnLine)); cell < end_cell; ++cell) {
    if (is_gap(static_cast<int>(line), cell, axis == 1)) return true;
  }
  return false;
}

/// Whether there are walls on both sides of the grid line, exactly a tight gap apart.
bool TightGaps::is_gap(int line, int cell, bool vertical) const {
  const int low = line - width_ / 2 - 1;
  const int high = line + width_ / 2;
  return vertical ? grid_.blocked({low, cell}) && grid_.blocked({high, cell})
                  : grid_.blocked({cell, low}) && grid_.blocked({cell, high});
}

namespace {

constexpr double kPi = std::numbers::pi;
/// Rounding of headings along an axis (radians): a move grazes a quarter within this of its end.
constexpr double kGrazing = 1e-12;

/// The headings on the bend around the corner.
const Quadrant& quadrant(const Corner& corner, bool left) {
  static constexpr std::array<Quadrant, 4> kQuadrants = {Quadrant{-1.0, -1.0, -0.75 * kPi},
                                                         {1.0, -1.0, -0.25 * kPi},
                                                         {-1.0, 1.0, 0.75 * kPi},
                                                         {1.0, 1.0, 0.25 * kPi}};
  // With the corner on the left, the direction away from the blocked cell is to the right.
  const bool east = left ? corner.away_y < 0 : corner.away_y > 0;
  const bool north = left ? corner.away_x > 0 : corner.away_x < 0;
  return kQuadrants[(north ? 2U : 0U) + (east ? 1U : 0U)];
}

/// The place on the bend at which the disk has this heading.
double angle_on_bend(const TangentEnd& end, double heading) {
  if (end.quadrant == nullptr) return 0.0;
  const double turned = rotation_between(end.quadrant->middle, heading);
  return end.offset > 0.0 ? turned : -turned;
}

}  // namespace

TangentEnd circle_around(const Corner& corner, const Position& center, double offset) {
  return {center, offset, &quadrant(corner, offset > 0.0)};
}

std::optional<Tangent> common_tangent(const TangentEnd& from, const TangentEnd& to) {
  const Position d = to.center - from.center;
  const double across = to.offset - from.offset;
  const double distance = d.norm();
  if (!(distance > std::abs(across))) return std::nullopt;
  const double sine = across / distance;
  const double cosine = std::sqrt(1.0 - sine * sine);
  const Position along = Position(d.x() * cosine + d.y() * sine, d.y() * cosine - d.x() * sine) / distance;
  if (!is_heading_of(from, along, kDirectionRounding) || !is_heading_of(to, along, kDirectionRounding)) {
    return std::nullopt;
  }
  Tangent tangent;
  tangent.heading = heading_of(along);
  tangent.leave_angle = angle_on_bend(from, tangent.heading);
  tangent.arrive_angle = angle_on_bend(to, tangent.heading);
  const bool grazes_first = std::abs(tangent.leave_angle + 0.25 * kPi) < kGrazing;
  const bool grazes_last = std::abs(tangent.arrive_angle - 0.25 * kPi) < kGrazing;
  if (grazes_first || grazes_last) return std::nullopt;
  tangent.length = distance * cosine;
  const Position left(-along.y(), along.x());
  tangent.begin = from.center - from.offset * left;
  tangent.end = to.center - to.offset * left;
  return tangent;
}

namespace {

constexpr double kQuarterTurn = 0.5 * std::numbers::pi;
/// The number of pieces in which an arc is tested, few enough for the bits of a number. Each piece is then
/// within 0.12 % of the radius from its chord.
constexpr int kPieces = 16;
constexpr double kPiece = kQuarterTurn / kPieces;
/// Rounding of places on a bend, in pieces.
constexpr double kPieceRounding = 1e-7;

/// The work of computing a tangent, and of testing a sweep against obstacles. Then, the number of corners in
/// the wrong direction that are rejected in one step of work. Measured.
constexpr int kTangentWork = 3;
constexpr int kRejectionsPerStep = 4;
constexpr int kSweepWork = 30;

/// The direction away from the blocked cell.
double away_direction(const Corner& corner) { return arctangent(corner.away_y, corner.away_x); }

}  // namespace

TangentGraph::TangentGraph(CornerVisibility& corners, const LineOfSight& sight, double radius,
                           bool stops_at_cell_centers)
    : corners_(corners),
      sight_(sight),
      radius_(radius - kRadiusReduction),
      tight_gaps_(corners.grid(), radius, stops_at_cell_centers),
      links_(2 * static_cast<std::size_t>(corners.count())),
      arcs_(static_cast<std::size_t>(corners.count())) {}

TangentEnd TangentGraph::circle_of(const Bend& bend) const {
  return circle_around(corners_.corner(bend.corner), corners_.position(bend.corner),
                       bend.left ? radius_ : -radius_);
}

std::optional<Tangent> TangentGraph::tangent(const TangentEnd& from, const TangentEnd& to) {
  ++work_;
  if (!may_be_tangent(from, to)) return std::nullopt;
  work_ += kTangentWork;
  return common_tangent(from, to);
}

std::optional<Tangent> TangentGraph::from_point(const Position& point, const Bend& to) {
  auto found = tangent(at_point(point), circle_of(to));
  if (found) found->to = to;
  return found;
}

std::optional<Tangent> TangentGraph::to_point(const Bend& from, const Position& point) {
  return tangent(circle_of(from), at_point(point));
}

std::span<const Tangent> TangentGraph::from(const Bend& bend) {
  Links& links = links_[index(bend)];
  if (links.begin < 0) links = link(bend);
  return {tangents_.begin() + links.begin, tangents_.begin() + links.end};
}

TangentGraph::Links TangentGraph::link(const Bend& bend) {
  const int begin = tangents_.next_index();
  const TangentEnd here = circle_of(bend);
  const std::vector<int>& corners = corners_.bends_from(bend.corner);
  work_ += static_cast<std::int64_t>(corners.size()) / kRejectionsPerStep;
  for (const int corner : corners) {
    if (corners_.stopped_at_step()) break;
    const Position d = corners_.position(corner) - here.center;
    if (!is_heading_of(here, d, tangent_slack(d, 2.0 * radius_))) continue;
    for (const bool left : {false, true}) {
      const Bend to{corner, left};
      const auto found = tangent(here, circle_of(to));
      if (!found) continue;
      tangents_.push_back(*found);
      tangents_.back().to = to;
    }
  }
  freedom_.resize(tangents_.size(), Freedom::unknown);
  std::stable_sort(tangents_.begin() + begin, tangents_.end(),
                   [](const Tangent& a, const Tangent& b) { return a.leave_angle > b.leave_angle; });
  return {begin, tangents_.next_index()};
}

bool TangentGraph::is_free(const Tangent& tangent) {
  work_ += kSweepWork;
  return sight_.may_sweep(tangent.begin, tangent.end, radius_ - kRadiusReduction) &&
         !tight_gaps_.crossed_by(tangent.begin, tangent.end, tangent.length);
}

bool TangentGraph::is_free(const Bend& bend, int k) {
  const int link = links_[index(bend)].begin + k;
  Freedom& freedom = freedom_[link];
  if (freedom == Freedom::unknown) freedom = is_free(tangents_[link]) ? Freedom::free : Freedom::blocked;
  return freedom == Freedom::free;
}

const TangentGraph::Arc& TangentGraph::arc(int corner) {
  Arc& arc = arcs_[corner];
  if (arc.known) return arc;
  arc.known = true;
  work_ += kPieces * kSweepWork;
  const double first = away_direction(corners_.corner(corner)) - 0.5 * kQuarterTurn;
  const Position center = corners_.position(corner);
  const auto at = [&](int k) {
    const double angle = first + k * kPiece;
    return Position(center + radius_ * unit_vector(angle));
  };
  const double off_chord = radius_ * (1.0 - cosine(0.5 * kPiece));
  for (int k = 0; k < kPieces; ++k) {
    if (!sight_.may_sweep(at(k), at(k + 1), radius_ - off_chord - kRadiusReduction)) arc.blocked |= 1u << k;
  }
  return arc;
}

bool TangentGraph::is_arc_free(const Bend& bend, double from_angle, double to_angle) {
  const double low = bend.left ? from_angle : -to_angle;
  const double high = bend.left ? to_angle : -from_angle;
  const int first =
      std::max(0, static_cast<int>(std::ceil((low + 0.5 * kQuarterTurn) / kPiece + kPieceRounding)));
  const int last =
      std::min(kPieces, static_cast<int>(std::floor((high + 0.5 * kQuarterTurn) / kPiece - kPieceRounding)));
  if (last <= first) return true;
  const std::uint32_t pieces = ((1u << last) - 1u) & ~((1u << first) - 1u);
  return (arc(bend.corner).blocked & pieces) == 0;
}

}  // namespace fleetplan::core
