#pragma once

// Where a robot can go from a label: the edges of the search and their departures.

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include "core/geometry/position.h"
#include "core/geometry/segment.h"
#include "core/geometry/tolerance.h"
#include "core/model/motion.h"
#include "core/reservation/reservation_table.h"
#include "core/runtime/stop_condition.h"
#include "core/sipp/goals.h"
#include "core/sipp/search_space.h"
#include "core/sipp/search_state.h"

namespace fleetplan::core {

/// The successors of labels for one robot: moves to neighbours, shortcuts from the parent (any-angle), moves
/// straight to the goal, and services. All that limits a move from a label is here: driving backwards, zones,
/// and loads that change from stage to stage. The loop of the search knows none of them.
class Successors {
 public:
  /// All arguments outlive this object.
  Successors(const ReservationTable& table, SearchSpace& space, const Goals& goals, SearchState& state,
             const StopCondition& stop);

  /// The place of a vertex in a stage, with its safe intervals; computed when it is reached for the first
  /// time.
  PlaceId place_of(int vertex, int stage);
  PlaceId goal_of(int stage) { return place_of(goals_.stage(stage).goal.vertex, stage); }

  /// If the label is at the goal of a stage before the last one, calls visit(entry) for its service, which
  /// leads to the next stage. Returns whether nothing else is worth while, because the service takes no time
  /// or the robot may stay until it ends.
  template <class Visit>
  bool visit_services(LabelId from, Visit&& visit);

  /// Calls visit(edge, interval) for every edge to another vertex. `interval` is the first one of the target
  /// into which the edge can lead.
  template <class Visit>
  void visit_edges(LabelId from, Visit&& visit);

  /// Tests an edge's shortcut against obstacles, once (paper, "Estimating the feasibility of the move w.r.t.
  /// static obstacles").
  void test_sight(Edge& edge) const;

  /// The earliest departure of a move that meets no robot and arrives within `target` (paper, "Estimating the
  /// feasibility of the move w.r.t. dynamic obstacles and computing earliest arrival time"); none if there is
  /// none, or if obstacles block the shortcut.
  std::optional<double> earliest_departure(const OpenEntry& entry, const SafeInterval& target) const;

 private:
  /// The vertices of the robot with the load that it carries in this stage.
  const Vertices& vertices(int stage) const {
    return changes_load_ ? *goals_.stage(stage).vertices : vertices_;
  }

  double earliest_arrival(const Position& position) const;
  void append_intervals(Place& place);
  void append_windows(const Place& place);

  template <class Visit>
  bool visit_services_with_other_load(LabelId from, const ServiceStop& stop, Visit&& visit);
  EdgeId add_service(LabelId from, PlaceId next, double heading);
  template <class Visit>
  void visit_goal(LabelId from, Visit&& visit);
  template <class Visit>
  void visit_edge(LabelId from, PlaceId target, int interval, bool with_shortcut, Visit&& visit);
  EdgeId add_edge(LabelId via, PlaceId target, bool with_shortcut, bool reverse);
  Move move_between(LabelId from, PlaceId target, bool reverse) const;

  std::optional<double> departure(int stage, const Segment& path, double duration, double t_min,
                                  double t_max) const;
  std::optional<double> departure_of(const std::vector<TimedSegment>& parts, double t_min, double t_max,
                                     const Footprint& footprint) const;

  const ReservationTable& table_;
  SearchSpace& space_;
  const Goals& goals_;
  SearchState& state_;
  const StopCondition& stop_;
  const Motion& motion_;
  const Vertices& vertices_;  // of the first stage
  const bool changes_load_;
  const double fastest_;     // metres per second, in any stage
  const bool has_parts_;     // whether moves may have parts of different speeds
  const bool may_continue_;  // whether a move may go on from the one before without the added wait
};

template <class Visit>
bool Successors::visit_services(LabelId from, Visit&& visit) {
  const Place& here = state_.place_at(from);
  if (here.stage == goals_.last_stage() || here.vertex != goals_.stage(here.stage).goal.vertex) return false;
  const Place place = here;
  const Label label = state_.labels[from];
  const ServiceStop stop = goals_.service_stop(label);
  const double t_end = std::max(stop.t_end, label.arrival);
  const double safe_until = state_.intervals[label.interval].end;
  if (t_end > safe_until) return false;
  if (changes_load_) {
    const bool is_offered = visit_services_with_other_load(from, stop, visit);
    return is_offered && (safe_until == kForever || place.is_window);
  }
  // The intervals of the place are the same in every stage.
  const PlaceId next = place_of(place.vertex, place.stage + 1);
  const int interval = state_.places[next].first_interval + label.interval - place.first_interval;
  const EdgeId edge = add_service(from, next, stop.heading);
  visit(OpenEntry{t_end, stop.t_rest, edge, interval, ArrivalId::none, MoveKind::service, false});
  return safe_until == kForever || (t_end == label.arrival && stop.heading == label.heading);
}

/// With another load in the next stage, other intervals may be safe there: those that contain the end of the
/// service. Returns whether there is one.
template <class Visit>
bool Successors::visit_services_with_other_load(LabelId from, const ServiceStop& stop, Visit&& visit) {
  constexpr double kRoundingOfTimes = 1e-9;  // seconds; more than the rounding of times
  const Label label = state_.labels[from];
  const int stage = state_.place_at(from).stage + 1;
  const Stage& next_stage = goals_.stage(stage);
  const int vertex = next_stage.is_rest
                         ? next_stage.goal.vertex
                         : next_stage.vertices->goals()[static_cast<std::size_t>(stage - 1)].vertex;
  const PlaceId next = place_of(vertex, stage);
  const double t_end = std::max(stop.t_end, label.arrival);
  const EdgeId edge = add_service(from, next, stop.heading);
  bool is_offered = false;
  for (int k = state_.places[next].first_interval; k < state_.places[next].end_interval; ++k) {
    const SafeInterval safe = state_.intervals[k];
    const bool contains = safe.begin <= stop.t_end + kRoundingOfTimes && t_end <= safe.end;
    if (!contains || (next_stage.is_rest && safe.end != kForever)) continue;
    visit(OpenEntry{std::max(t_end, safe.begin), stop.t_rest, edge, k, ArrivalId::none, MoveKind::service,
                    false});
    is_offered = true;
  }
  return is_offered;
}

template <class Visit>
void Successors::visit_edges(LabelId from, Visit&& visit) {
  const Label& label = state_.labels[from];
  const int vertex = state_.places[label.place].vertex;
  const int stage = state_.places[label.place].stage;
  const int before = label.by_translation ? state_.place_at(label.parent).vertex : -1;
  const Vertices& view = vertices(stage);
  if (view.any_angle()) visit_goal(from, visit);
  view.for_each_neighbour(vertex, [&](int neighbour) {
    if (!view.allow(vertex, neighbour)) return;
    const PlaceId target = place_of(neighbour, stage);
    if (state_.places[target].never_safe()) return;
    // With inertia, a stop in a straight line costs time, on any lattice.
    const bool has_shortcuts = view.any_angle() || motion_.linear_inertia.is_limited;
    const bool with_shortcut = has_shortcuts && before >= 0 && neighbour != before;
    visit_edge(from, target, state_.places[target].first_interval, with_shortcut, visit);
  });
}

/// If the goal of the stage is in sight, the straight move there; to the last goal only into the interval in
/// which the robot may stay.
template <class Visit>
void Successors::visit_goal(LabelId from, Visit&& visit) {
  const PlaceId here = state_.labels[from].place;
  const int stage = state_.places[here].stage;
  if (here == goals_.last() || !state_.places[here].estimate.straight) return;
  // A long move beyond the horizon would be in the way of others that rest there.
  if (state_.labels[from].arrival + state_.places[here].estimate.seconds > goals_.horizon()) return;
  const PlaceId target = stage == goals_.last_stage() ? goals_.last() : goal_of(stage);
  const Place& goal = state_.places[target];
  if (stage != goals_.last_stage()) {
    visit_edge(from, target, goal.first_interval, false, visit);
  } else if (!goal.never_safe()) {
    visit_edge(from, target, goal.end_interval - 1, false, visit);
  }
}

/// Forwards and, for a robot that may reverse, backwards. A shortcut replaces two moves forwards, or two
/// backwards.
template <class Visit>
void Successors::visit_edge(LabelId from, PlaceId target, int interval, bool with_shortcut, Visit&& visit) {
  const bool reversed = state_.labels[from].reverse;
  visit(add_edge(from, target, with_shortcut && !reversed, false), interval);
  if (motion_.may_reverse) visit(add_edge(from, target, with_shortcut && reversed, true), interval);
}

}  // namespace fleetplan::core
