#pragma once

// The straight moves and bends that taut paths consist of.

#include <cmath>
#include <cstdint>
#include <optional>
#include <span>

#include "core/bounds/corner_visibility.h"
#include "core/geometry/position.h"
#include "core/map/line_of_sight.h"
#include "core/map/occupancy_grid.h"
#include "core/runtime/arrays.h"

namespace fleetplan::core {

/// Gaps of an even number of cells that a disk fits exactly. Its centre would have to move along a grid line
/// there. A robot that starts, stops and turns on cell centres never does.
class TightGaps {
 public:
  /// `radius` of the robot, metres. If it may stop elsewhere than at centres of cells, no gap is tight.
  TightGaps(const OccupancyGrid& grid, double radius, bool stops_at_cell_centers);

  /// Whether a move of this length from `begin` to `end` (metres) passes through such a gap.
  bool crossed_by(const Position& begin, const Position& end, double length) const;

 private:
  bool is_gap(int line, int cell, bool vertical) const;

  const OccupancyGrid& grid_;
  int width_;  // cells, even; 0 if the disk has no tight gap
};

/// One of the two ways around a corner: a quarter of a circle of the disk's radius around the corner. The
/// quarter faces away from the blocked cell. The corner is on the left or on the right. A place on the bend
/// is an angle, from -pi/4 at its beginning to pi/4 at its end.
struct Bend {
  int corner = 0;
  bool left = false;  // the corner is on the left
};

/// A straight move that is tangent to the circles of the corners that it links, or ends at a given point.
struct Tangent {
  Bend to;                    // meaningless where the move ends at a point
  double leave_angle = 0.0;   // the place on the bend that it starts from; 0 from a point
  double arrive_angle = 0.0;  // the place on `to`; 0 at a point
  double length = 0.0;        // metres
  double heading = 0.0;
  Position begin{0.0, 0.0};
  Position end{0.0, 0.0};
};

/// The quadrant that contains all headings of a disk on a bend: the signs of their cosine and sine, and the
/// heading in the middle.
struct Quadrant {
  double x;
  double y;
  double middle;  // radians
};

/// A circle that a tangent touches, or a point where it ends.
struct TangentEnd {
  Position center;
  double offset;             // metres from the move to the circle's centre, > 0 on the left; 0: a point
  const Quadrant* quadrant;  // null: a point
};

/// Returns the end of a tangent that touches the circle around `corner`, which is at `center`. `offset`: as
/// in TangentEnd.
TangentEnd circle_around(const Corner& corner, const Position& center, double offset);
inline TangentEnd at_point(const Position& point) { return {point, 0.0, nullptr}; }

/// Rounding of the direction of a tangent that crosses between two circles that nearly touch (radians).
inline constexpr double kDirectionRounding = 1e-7;

/// Whether `direction` is a heading of the bend. Each of its components may be off by `slack`.
inline bool is_heading_of(const TangentEnd& end, const Position& direction, double slack) {
  return end.quadrant == nullptr ||
         (direction.x() * end.quadrant->x >= -slack && direction.y() * end.quadrant->y >= -slack);
}

/// Let `d` be the vector between two centres, and `across` the difference of their circles' offsets. Returns
/// how much a component of `d` may differ from the same component of a tangent of the circles.
inline double tangent_slack(const Position& d, double across) {
  return across + kDirectionRounding * (std::abs(d.x()) + std::abs(d.y()));
}

/// A necessary condition for a tangent, quickly computed.
inline bool may_be_tangent(const TangentEnd& from, const TangentEnd& to) {
  const Position d = to.center - from.center;
  const double slack = tangent_slack(d, std::abs(to.offset - from.offset));
  return is_heading_of(from, d, slack) && is_heading_of(to, d, slack);
}

/// The tangent, without `to`. None if it does not exist or touches a circle outside its bend. Also none if it
/// runs along an axis and only grazes a bend: the beginning of the bend that it leaves, or the end of the
/// other bend. No taut path bends there, because one longer move does the same.
std::optional<Tangent> common_tangent(const TangentEnd& from, const TangentEnd& to);

/// The tangent graph of a disk of one radius (Liu and Arimoto, IJRR 1992). A taut path cannot be made shorter
/// by pulling. It consists of straight moves, and of arcs of the disk's radius around convex corners: the
/// edges and nodes of the graph. Tangents through tight gaps (see TightGaps) are left out. Computed on first
/// use; not thread-safe.
///
/// Tests against obstacles allow for kRadiusReduction, so that no taut path of a disk in contact with
/// obstacles is missed.
class TangentGraph {
 public:
  /// Metres by which the disk is smaller than the robot: 200 times the slack of the search. So neither the
  /// slack nor rounding makes a path of the robot impossible for the disk.
  static constexpr double kRadiusReduction = 1e-7;

  /// The graph for a robot of `radius` metres (> 2 kRadiusReduction). `stops_at_cell_centers`: whether
  /// centres of cells are the only vertices of its lattice. Otherwise, no gap is tight.
  TangentGraph(CornerVisibility& corners, const LineOfSight& sight, double radius,
               bool stops_at_cell_centers = true);

  /// The radius of the disk, metres: the robot's radius minus kRadiusReduction.
  double radius() const { return radius_; }
  int bend_count() const { return 2 * corners_.count(); }
  static int index(const Bend& bend) { return 2 * bend.corner + (bend.left ? 1 : 0); }

  // Tangents that are returned may cross obstacles: see `is_free`.

  /// Returns the tangents from a bend to other bends, by descending leave_angle. They may cross obstacles,
  /// see is_free(). The span is valid until the next call.
  std::span<const Tangent> from(const Bend& bend);
  std::optional<Tangent> from_point(const Position& point, const Bend& to);
  std::optional<Tangent> to_point(const Bend& from, const Position& point);

  bool is_free(const Tangent& tangent);
  /// Whether the k-th tangent in `from(bend)` is free. The result is stored.
  bool is_free(const Bend& bend, int k);
  /// Whether the disk can follow the arc between two places on the bend. Obstacles that reach less than a
  /// piece of 5.6 degrees into the arc may be overlooked.
  bool is_arc_free(const Bend& bend, double from_angle, double to_angle);

  /// The work done so far, in steps of 10 to 20 ns.
  std::int64_t work() const { return work_; }

 private:
  enum class Freedom : std::uint8_t { unknown, blocked, free };
  struct Links {     // a range of tangents_
    int begin = -1;  // not yet computed
    int end = -1;
  };
  struct Arc {
    std::uint32_t blocked = 0;  // a bit for each piece, counter-clockwise
    bool known = false;
  };

  TangentEnd circle_of(const Bend& bend) const;
  std::optional<Tangent> tangent(const TangentEnd& from, const TangentEnd& to);
  Links link(const Bend& bend);
  const Arc& arc(int corner);

  CornerVisibility& corners_;
  const LineOfSight& sight_;
  double radius_;
  TightGaps tight_gaps_;
  IndexedVector<Links> links_;       // by bend
  IndexedVector<Tangent> tangents_;  // between bends
  IndexedVector<Freedom> freedom_;   // whether each of tangents_ is free
  IndexedVector<Arc> arcs_;          // by corner
  std::int64_t work_ = 0;
};

}  // namespace fleetplan::core
