#include "core/bounds/tangent_graph.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace fleetplan::core {
namespace {

constexpr double kQuarterTurn = 0.5 * std::numbers::pi;
/// The number of pieces in which an arc is tested, few enough for the bits of a number; each is then within
/// 0.12 % of the radius from its chord.
constexpr int kPieces = 16;
constexpr double kPiece = kQuarterTurn / kPieces;
/// Rounding of places on a bend, in pieces.
constexpr double kPieceRounding = 1e-7;

/// The work of computing a tangent, and of testing a sweep against obstacles; and the number of corners in
/// the wrong direction that are rejected in one step of work. Measured.
constexpr int kTangentWork = 3;
constexpr int kRejectionsPerStep = 4;
constexpr int kSweepWork = 30;

/// The direction away from the blocked cell.
double away_direction(const Corner& corner) { return std::atan2(corner.away_y, corner.away_x); }

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
    return Position(center + radius_ * Position(std::cos(angle), std::sin(angle)));
  };
  const double off_chord = radius_ * (1.0 - std::cos(0.5 * kPiece));
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
