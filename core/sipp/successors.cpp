#include "core/sipp/successors.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/tolerance.h"
#include "core/sipp/moves.h"

namespace fleetplan::core {
namespace {

/// The greatest linear speed of the robot in any stage, metres per second.
double greatest_speed(const SearchSpace& space) {
  double greatest = space.vertices().body().linear_speed;
  if (!space.changes_load()) return greatest;
  // Bounded: the goals of one robot.
  for (std::size_t stage = 0; stage <= space.goal_count(); ++stage) {
    greatest = std::max(greatest, space.vertices(stage).body().linear_speed);
  }
  return greatest;
}

}  // namespace

Successors::Successors(const ReservationTable& table, SearchSpace& space, const Goals& goals,
                       SearchState& state, const StopCondition& stop)
    : table_(table),
      space_(space),
      goals_(goals),
      state_(state),
      stop_(stop),
      body_(space.vertices().body()),
      vertices_(space.vertices()),
      changes_load_(space.changes_load()),
      fastest_(greatest_speed(space)),
      may_continue_(body_.wait_before_move > 0.0 && !body_.linear_inertia.is_limited) {}

PlaceId Successors::place_of(int vertex, int stage) {
  const int number = changes_load_ ? goals_.stage(stage).first_vertex + vertex : vertex;
  PlaceId& latest = state_.place_of_vertex[number];
  PlaceId known = latest;
  while (known != PlaceId::none && state_.places[known].stage != stage) {
    known = state_.places[known].other_stage;
  }
  if (known != PlaceId::none) return known;
  const Stage& at = goals_.stage(stage);
  Place place{
      vertex, stage, number, vertices(stage).position(vertex), {}, false, state_.intervals.next_index(),
      0,      latest};
  if (at.is_anywhere) {
    place.any_heading = true;
  } else if (vertex != at.goal_pose.vertex) {
    place.estimate = space_.cost_to_go(static_cast<std::size_t>(stage)).from(vertex, stop_);
    place.estimate.seconds += at.after;
    place.estimate.reverse_seconds += at.after;
  } else {
    place.estimate = {at.after, at.goal_pose.heading.value_or(0.0), false};
    place.any_heading = !at.goal_pose.heading;
  }
  append_intervals(place);
  latest = state_.places.push_back(place);
  return latest;
}

/// No earlier than straight from the start at the greatest speed, seconds.
double Successors::earliest_arrival(const Position& position) const {
  const double distance = (position - vertices_.position(vertices_.start())).norm();
  return space_.t_begin() + distance / fastest_;
}

/// The safe intervals of a vertex are the same in all stages with the same load.
void Successors::append_intervals(Place& place) {
  const Stage& at = goals_.stage(place.stage);
  if (at.radius_changes && place.vertex == at.goal_pose.vertex) {
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
    const double t_from = earliest_arrival(place.position);
    for (const SafeInterval& safe : table_.safe_intervals(at.footprint, place.position, t_from)) {
      state_.intervals.push_back(safe);
    }
  }
  place.end_interval = state_.intervals.next_index();
  state_.dominance.set_interval_count(state_.intervals.size());
}

/// The arrivals at a goal from which the robot may be served there with its radius, and may be there with its
/// next radius when the service ends. A rotation before the service only delays its end.
void Successors::append_windows(const Place& place) {
  const Stage& at = goals_.stage(place.stage);
  const Stage& next = goals_.stage(place.stage + 1);
  const double t_from = earliest_arrival(place.position);
  const std::vector<SafeInterval> after = table_.safe_intervals(next.footprint, place.position, t_from);
  auto begin = after.begin();
  // Bounded: the intervals are ascending. Each is left behind once, or overlaps another interval.
  for (const SafeInterval& before : table_.safe_intervals(at.footprint, place.position, t_from)) {
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

Successors::Services Successors::services_from(LabelId from) {
  const Place& here = state_.place_at(from);
  if (here.stage == goals_.last_stage() || here.vertex != goals_.stage(here.stage).goal_pose.vertex)
    return {};
  const Place place = here;
  const Label label = state_.labels[from];
  const ServiceStop stop = goals_.service_stop(label);
  const double t_end = std::max(stop.t_end, label.arrival);
  const double safe_until = state_.intervals[label.interval].end;
  if (t_end > safe_until) return {};
  if (changes_load_) {
    Services services{services_with_other_load(from, stop)};
    services.suffice = !services.entries.empty() && (safe_until == kForever || place.is_window);
    return services;
  }
  // The intervals of the place are the same in every stage.
  const PlaceId next = place_of(place.vertex, place.stage + 1);
  const int interval = state_.places[next].first_interval + label.interval - place.first_interval;
  const EdgeId edge = add_service(from, next, stop.heading);
  return {{{t_end, stop.t_rest, edge, interval, ArrivalId::none, MoveKind::service, false}},
          safe_until == kForever || (t_end == label.arrival && stop.heading == label.heading)};
}

/// With another load in the next stage, other intervals may be safe there. They must contain the end of the
/// service.
std::vector<OpenEntry> Successors::services_with_other_load(LabelId from, const ServiceStop& stop) {
  constexpr double kRoundingOfTimes = 1e-9;  // seconds; more than the rounding of times
  const Label label = state_.labels[from];
  const int stage = state_.place_at(from).stage + 1;
  const Stage& next_stage = goals_.stage(stage);
  const int vertex = next_stage.is_rest
                         ? next_stage.goal_pose.vertex
                         : next_stage.vertices->goals()[static_cast<std::size_t>(stage - 1)].vertex;
  const PlaceId next = place_of(vertex, stage);
  const double t_end = std::max(stop.t_end, label.arrival);
  const EdgeId edge = add_service(from, next, stop.heading);
  std::vector<OpenEntry> services;
  for (int k = state_.places[next].first_interval; k < state_.places[next].end_interval; ++k) {
    const SafeInterval safe = state_.intervals[k];
    const bool contains = safe.begin <= stop.t_end + kRoundingOfTimes && t_end <= safe.end;
    if (!contains || (next_stage.is_rest && safe.end != kForever)) continue;
    services.push_back(
        {std::max(t_end, safe.begin), stop.t_rest, edge, k, ArrivalId::none, MoveKind::service, false});
  }
  return services;
}

/// The robot rests, in this heading, until the service ends.
EdgeId Successors::add_service(LabelId from, PlaceId next, double heading) {
  Move at_rest;
  at_rest.heading = heading;
  return state_.edges.push_back({at_rest, {}, from, next, Edge::Sight::blocked});
}

Successors::EdgeRange Successors::add_edges(LabelId from) {
  const auto first = static_cast<int>(state_.edges.size());
  const Label& label = state_.labels[from];
  const int vertex = state_.places[label.place].vertex;
  const int stage = state_.places[label.place].stage;
  const int before = label.by_translation ? state_.place_at(label.parent).vertex : -1;
  const Vertices& view = vertices(stage);
  if (view.any_angle()) add_edge_to_goal(from);
  view.for_each_neighbour(vertex, [&](int neighbour) {
    if (!view.allow(vertex, neighbour) || !view.may_visit(neighbour, goals_.stage(stage).goal_pose.vertex))
      return;
    const PlaceId target = place_of(neighbour, stage);
    if (state_.places[target].never_safe()) return;
    // With inertia, a stop in a straight line costs time, on any lattice.
    const bool has_shortcuts = view.any_angle() || body_.linear_inertia.is_limited;
    const bool with_shortcut = has_shortcuts && before >= 0 && neighbour != before;
    add_edges_to(from, target, state_.places[target].first_interval, with_shortcut);
  });
  return {first, static_cast<int>(state_.edges.size())};
}

/// Adds the straight move to the goal of the stage if it is in sight. To the last goal, only into the
/// interval in which the robot may stay.
void Successors::add_edge_to_goal(LabelId from) {
  const PlaceId here = state_.labels[from].place;
  const int stage = state_.places[here].stage;
  if (here == goals_.last() || !state_.places[here].estimate.straight) return;
  // A long move beyond the horizon would be in the way of others that rest there.
  if (state_.labels[from].arrival + state_.places[here].estimate.seconds > goals_.horizon()) return;
  const PlaceId target = stage == goals_.last_stage() ? goals_.last() : goal_of(stage);
  const Place& goal = state_.places[target];
  if (stage != goals_.last_stage()) {
    add_edges_to(from, target, goal.first_interval, false);
  } else if (!goal.never_safe()) {
    add_edges_to(from, target, goal.end_interval - 1, false);
  }
}

/// Forwards and, for a robot that may reverse, backwards. A shortcut replaces two moves forwards, or two
/// backwards.
void Successors::add_edges_to(LabelId from, PlaceId target, int interval, bool with_shortcut) {
  const bool reversed = state_.labels[from].reverse;
  add_edge(from, target, interval, with_shortcut && !reversed, false);
  if (body_.may_reverse) add_edge(from, target, interval, with_shortcut && reversed, true);
}

/// `interval`: the first one of the target into which the edge may lead.
void Successors::add_edge(LabelId via, PlaceId target, int interval, bool with_shortcut, bool reverse) {
  const Move local = move_between(via, target, reverse);
  Move shortcut = with_shortcut ? move_between(state_.labels[via].parent, target, reverse) : Move{};
  // Past a slow zone, the way round may be the faster one.
  const bool is_slower = vertices(state_.places[target].stage).times().limit_speeds() &&
                         shortcut.ready + shortcut.duration > local.ready + local.duration + kSameTime;
  with_shortcut = with_shortcut && !is_slower;
  if (with_shortcut && !vertices_.any_angle()) {
    with_shortcut = angle_between(shortcut.heading, local.heading) <= kSameHeading;
  }
  if (!with_shortcut) shortcut = Move{};
  state_.edges.push_back(
      {local, shortcut, via, target, with_shortcut ? Edge::Sight::unknown : Edge::Sight::blocked, interval});
}

/// The rotation, the added wait and the translation from a label (paper, "Handling rotations").
inline Move Successors::move_between(LabelId from, PlaceId target, bool reverse) const {
  const Label& label = state_.labels[from];
  const Place& here = state_.places[label.place];
  const Place& there = state_.places[target];
  const Vertices& view = vertices(here.stage);
  const Displacement d = view.between(here.vertex, there.vertex);
  Move move;
  move.heading = reverse ? opposite_heading(d.heading) : d.heading;
  move.reverse = reverse;
  move.duration = view.times().translation_time(d.length, [&] {
    return Segment{here.position, there.position};
  });
  double rotation = view.times().rotation_time(here.position, label.heading, move.heading);
  if (label.parent == LabelId::none && space_.any_heading_at_start()) rotation = 0.0;
  move.ready = label.arrival + rotation + body_.wait_before_move;
  move.latest = changes_load_ ? goals_.latest_departure(label) : state_.intervals[label.interval].end;
  move.continues_straight = may_continue_ && label.by_translation && label.reverse == reverse &&
                            angle_between(label.heading, move.heading) <= kSameHeading;
  move.at_source_from = label.arrival;
  return move;
}

void Successors::test_sight(Edge& edge) const {
  if (edge.shortcut_sight != Edge::Sight::unknown) return;
  const int from = state_.place_at(state_.source_of(edge, MoveKind::shortcut)).vertex;
  const Place& target = state_.places[edge.target];
  const bool free = vertices(target.stage).in_sight(from, target.vertex);
  edge.shortcut_sight = free ? Edge::Sight::free : Edge::Sight::blocked;
}

std::optional<double> Successors::earliest_departure(const OpenEntry& entry,
                                                     const SafeInterval& target) const {
  const Edge& edge = state_.edges[entry.edge];
  if (entry.kind == MoveKind::shortcut && edge.shortcut_sight == Edge::Sight::blocked) return std::nullopt;
  const Move& move = edge.move(entry.kind);
  const Segment path{state_.place_at(state_.source_of(edge, entry.kind)).position,
                     state_.places[edge.target].position};
  const int stage = state_.places[edge.target].stage;
  if (move.may_continue_into(target)) {
    const auto at_once = departure(stage, path, move.duration, move.at_source_from, move.at_source_from);
    if (at_once) return at_once;
  }
  const double begin = move.ready_for(target), latest = move.latest_into(target);
  if (begin > latest) return std::nullopt;
  return departure(stage, path, move.duration, begin, latest);
}

std::optional<double> Successors::departure(int stage, const Segment& path, double duration, double t_min,
                                            double t_max) const {
  return fleetplan::core::earliest_departure(table_, goals_.stage(stage).footprint, vertices(stage).times(),
                                             path, duration, t_min, t_max);
}

}  // namespace fleetplan::core
