#include <algorithm>
#include <cstddef>

#include "core/geometry/segment.h"
#include "core/sipp/search.h"

namespace fleetplan::core {
namespace {

/// Goals between two checks of the stop condition.
constexpr int kGoalsBetweenStops = 64;

}  // namespace

/// Prepares a pass. Returns false if the stop condition is met, or if the last goal has no safe interval
/// without end, or another one has none that is long enough; with a horizon, the path may end elsewhere.
bool Search::begin(Pass pass) {
  pass_ = pass;
  use_slack_ = pass == Pass::quick && limits_.dominance_slack > 0.0;
  state_.clear();
  state_.place_of_vertex.resize(
      std::max(state_.place_of_vertex.size(), static_cast<std::size_t>(space_.vertex_count())),
      PlaceId::none);
  const double slack = use_slack_ ? limits_.dominance_slack * vertices_.spacing() : 0.0;
  state_.dominance.reset(vertices_.slowest_motion(), motion_.translation_time(slack));
  state_.stages = stages_of(space_, stop_);
  stopped_ = state_.stages.empty();
  if (stopped_) return false;
  state_.goal = goal_of(last_stage_);
  const Place& goal = state_.places[state_.goal];
  const bool stays_free = !goal.never_safe() && state_.intervals[goal.end_interval - 1].end == kForever;
  if (!stays_free && !has_horizon()) return false;
  const double free_from = stays_free ? state_.intervals[goal.end_interval - 1].begin : kForever;
  state_.horizon = limits_.horizon;
  set_releases(state_.stages, std::min(free_from, limits_.horizon));
  state_.release = state_.stages[0].release;
  return has_horizon() || can_serve_all();
}

/// Whether each goal before the last one is free for long enough, at some time.
bool Search::can_serve_all() {
  for (int k = 0; k < last_stage_; ++k) {
    stopped_ = k % kGoalsBetweenStops == kGoalsBetweenStops - 1 && stop_.met();
    if (stopped_) return false;
    const Place goal = state_.places[goal_of(k)];
    const double done = k == 0 ? space_.itinerary().service_done : 0.0;
    bool can_serve = false;
    for (int i = goal.first_interval; i < goal.end_interval; ++i) {
      const SafeInterval& safe = state_.intervals[i];
      can_serve = can_serve || state_.stages[k].service_end(safe.begin) - done <= safe.end;
    }
    if (!can_serve) return false;
  }
  return true;
}

/// Tests the shortcut against obstacles, once.
void Search::test_sight(Edge& edge) const {
  if (edge.shortcut_sight != Edge::Sight::unknown) return;
  const int from = place_at(source_of(edge, EdgeKind::shortcut)).vertex;
  const Place& target = state_.places[edge.target];
  const bool free = vertices(target.stage).in_sight(from, target.vertex);
  edge.shortcut_sight = free ? Edge::Sight::free : Edge::Sight::blocked;
}

/// The place of a vertex in a stage, with its safe intervals; computed when it is reached for the first time.
PlaceId Search::place_of(int vertex, int stage) {
  const int number = changes_radius_ ? state_.stages[stage].first_vertex + vertex : vertex;
  PlaceId& latest = state_.place_of_vertex[number];
  PlaceId known = latest;
  while (known != PlaceId::none && state_.places[known].stage != stage) {
    known = state_.places[known].other_stage;
  }
  if (known != PlaceId::none) return known;
  const Stage& at = state_.stages[stage];
  Place place{
      vertex, stage, number, vertices(stage).position(vertex), {}, false, state_.intervals.next_index(),
      0,      latest};
  if (vertex != at.goal.vertex) {
    place.estimate = space_.cost_to_go(static_cast<std::size_t>(stage)).from(vertex, stop_);
    place.estimate.seconds += at.after;
    place.estimate.reverse_seconds += at.after;
  } else {
    place.estimate = {at.after, at.goal.heading.value_or(0.0), false};
    place.any_heading = !at.goal.heading;
  }
  append_intervals(place);
  latest = state_.places.push_back(place);
  return latest;
}

/// Those of the vertex in another stage with this radius are the same.
void Search::append_intervals(Place& place) {
  const Stage& at = state_.stages[place.stage];
  if (at.radius_changes && place.vertex == at.goal.vertex) {
    // A robot that begins in the place of its goal may be there outside a window.
    place.is_window = place.stage > 0 || place.vertex != at.vertices->start();
  }
  PlaceId same = place.other_stage;
  while (same != PlaceId::none && state_.places[same].is_window) same = state_.places[same].other_stage;
  if (place.is_window) {
    append_windows(place);
  } else if (same != PlaceId::none) {
    const Place& other = state_.places[same];
    for (int k = other.first_interval; k < other.end_interval; ++k) {
      state_.intervals.push_back(SafeInterval(state_.intervals[k]));
    }
  } else {
    for (const SafeInterval& safe : table_.safe_intervals(robot_, place.position, at.narrower)) {
      state_.intervals.push_back(safe);
    }
  }
  place.end_interval = state_.intervals.next_index();
  state_.dominance.set_interval_count(state_.intervals.size());
}

/// The arrivals at a goal from which the robot may be served there with the radius that it has, and be there
/// with the next one when the service ends. A rotation before the service only ends it later.
void Search::append_windows(const Place& place) {
  const Stage& at = state_.stages[place.stage];
  const Stage& next = state_.stages[place.stage + 1];
  const std::vector<SafeInterval> after = table_.safe_intervals(robot_, place.position, next.narrower);
  auto begin = after.begin();
  // Bounded: the intervals, which are ascending: each is left behind once, or overlaps another one.
  for (const SafeInterval& before : table_.safe_intervals(robot_, place.position, at.narrower)) {
    while (begin != after.end() && begin->end < before.begin) ++begin;
    for (auto later = begin; later != after.end() && later->begin <= before.end; ++later) {
      const SafeInterval& then = *later;
      if (next.is_rest && then.end != kForever) continue;
      double first = before.begin;
      if (at.service_end(first) < then.begin) first = std::max(first, then.begin - at.service);
      const double last = std::min(before.end, then.end);
      if (at.service_end(first) <= last) state_.intervals.push_back({first, last});
    }
  }
}

}  // namespace fleetplan::core
