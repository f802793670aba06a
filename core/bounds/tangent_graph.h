#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "core/bounds/corner_visibility.h"
#include "core/bounds/tangent.h"
#include "core/bounds/tight_gaps.h"
#include "core/geometry/position.h"
#include "core/map/line_of_sight.h"
#include "core/runtime/indexed_vector.h"

namespace fleetplan::core {

/// The tangent graph of a disk of one radius (Liu and Arimoto, IJRR 1992). A taut path, one that cannot be
/// made shorter by pulling, consists of straight moves and arcs of the disk's radius around convex corners:
/// the edges and nodes of the graph. Tangents through tight gaps (see TightGaps) are left out. Computed on
/// first use; not thread-safe. Tests against obstacles allow for kRadiusReduction, so that no taut path of a
/// disk that is in contact with obstacles is missed.
class TangentGraph {
 public:
  /// Metres by which the disk is smaller than the robot; 200 times the slack of the search, so
  /// that neither that nor rounding makes a path of the robot impossible for the disk.
  static constexpr double kRadiusReduction = 1e-7;

  /// `radius` > 2 kRadiusReduction is the robot's, metres.
  /// `stops_at_cell_centers`: as for TightGaps.
  TangentGraph(CornerVisibility& corners, const LineOfSight& sight, double radius,
               bool stops_at_cell_centers = true);

  /// Metres, reduced.
  double radius() const { return radius_; }
  int bend_count() const { return 2 * corners_.count(); }
  static int index(const Bend& bend) { return 2 * bend.corner + (bend.left ? 1 : 0); }

  // Tangents that are returned may cross obstacles: see `is_free`.

  /// All from a bend to others, by descending leave_angle; valid until the next call.
  std::span<const Tangent> from(const Bend& bend);
  std::optional<Tangent> from_point(const Position& point, const Bend& to);
  std::optional<Tangent> to_point(const Bend& from, const Position& point);

  bool is_free(const Tangent& tangent);
  /// Of the k-th tangent in `from(bend)`; the result is stored.
  bool is_free(const Bend& bend, int k);
  /// Whether the disk can follow the arc between two places on the bend. True as well where obstacles reach
  /// less than a piece of 5.6 degrees into it.
  bool is_arc_free(const Bend& bend, double from_angle, double to_angle);

  /// The work done so far, in steps of 10 to 20 ns.
  std::int64_t work() const { return work_; }

 private:
  enum class Freedom : std::uint8_t { unknown, blocked, free };
  struct Links {     // in tangents_
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
  IndexedVector<Freedom> freedom_;   // of tangents_
  IndexedVector<Arc> arcs_;          // by corner
  std::int64_t work_ = 0;
};

}  // namespace fleetplan::core
