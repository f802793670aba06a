#pragma once

// Where a robot can go from a label: the edges of the search and their departures.

#include <cstddef>
#include <optional>
#include <vector>

#include "core/geometry/position.h"
#include "core/geometry/segment.h"
#include "core/model/body.h"
#include "core/reservation/reservation_table.h"
#include "core/runtime/stop_condition.h"
#include "core/sipp/goals.h"
#include "core/sipp/search_space.h"
#include "core/sipp/search_state.h"

namespace fleetplan::core {

/// The successors of labels for one robot: moves to neighbours, shortcuts from the parent (any-angle), moves
/// straight to the goal, and services.
///
/// This class knows how a move depends on driving backwards, on zones, and on loads that change from stage to
/// stage. The loop of the search does not. Three parts are elsewhere:
///
/// - Goals::latest_departure says when a robot has to leave before its radius changes.
/// - Goals::trajectory_to divides the moves of the result at zones.
/// - Search::heading_at_start chooses the direction of a robot that may have any heading.
class Successors {
 public:
  /// All arguments outlive this object.
  Successors(const ReservationTable& table, SearchSpace& space, const Goals& goals, SearchState& state,
             const StopCondition& stop);

  /// The place of a vertex in a stage, with its safe intervals. Computed when it is first reached.
  PlaceId place_of(int vertex, int stage);
  PlaceId goal_of(int stage) { return place_of(goals_.stage(stage).goal_pose.vertex, stage); }

  /// The service that a label begins, with its timed entries.
  struct Services {
    std::vector<OpenEntry> entries;  // one, or one for each safe interval of a robot whose load changes
    /// No other move from the label is worth while, because the service takes no time or the robot may stay
    /// until it ends.
    bool suffice = false;
  };
  /// The service that leads to the next stage, if the label is at the goal of a stage before the last one.
  Services services_from(LabelId from);

  /// Numbers of SearchState::edges.
  struct EdgeRange {
    int first;
    int end;  // one past the last one
  };
  /// Adds the edges from a label to other vertices. They lead to its neighbours, each with the shortcut from
  /// its parent, and, any-angle, straight to the goal in sight.
  EdgeRange add_edges(LabelId from);

  /// Tests an edge's shortcut against obstacles, once (paper, "Estimating the feasibility of the move w.r.t.
  /// static obstacles").
  void test_sight(Edge& edge) const;

  /// The earliest departure of a move that meets no robot and arrives within `target`. None if there is no
  /// such departure, or if obstacles block the shortcut. Paper, "Estimating the feasibility of the move
  /// w.r.t. dynamic obstacles and computing earliest arrival time".
  std::optional<double> earliest_departure(const OpenEntry& entry, const SafeInterval& target) const;

 private:
  /// The vertices of the robot with the load that it carries in this stage.
  const Vertices& vertices(int stage) const {
    return changes_load_ ? *goals_.stage(stage).vertices : vertices_;
  }

  double earliest_arrival(const Position& position) const;
  void append_intervals(Place& place);
  void append_windows(const Place& place);

  std::vector<OpenEntry> services_with_other_load(LabelId from, const ServiceStop& stop);
  EdgeId add_service(LabelId from, PlaceId next, double heading);
  void add_edge_to_goal(LabelId from);
  void add_edges_to(LabelId from, PlaceId target, int interval, bool with_shortcut);
  void add_edge(LabelId via, PlaceId target, int interval, bool with_shortcut, bool reverse);
  Move move_between(LabelId from, PlaceId target, bool reverse) const;

  std::optional<double> departure(int stage, const Segment& path, double duration, double t_min,
                                  double t_max) const;

  const ReservationTable& table_;
  SearchSpace& space_;
  const Goals& goals_;
  SearchState& state_;
  const StopCondition& stop_;
  const Body& body_;
  const Vertices& vertices_;  // of the first stage
  const bool changes_load_;
  const double fastest_;     // metres per second, in any stage
  const bool may_continue_;  // whether a move may go on from the one before without the added wait
};

}  // namespace fleetplan::core
