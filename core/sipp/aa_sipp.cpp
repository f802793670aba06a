#include "core/sipp/aa_sipp.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "core/geometry/angle.h"
#include "core/geometry/tolerance.h"
#include "core/sipp/search.h"

namespace fleetplan::core {
namespace {

/// Loop steps between two checks of the stop condition.
constexpr int kStopStride = 32;
/// Seconds: more than the rounding of times.
constexpr double kRoundingOfTimes = 1e-9;
/// Seconds; far more than the tolerances of times and headings with which a rest counts as a service.
constexpr double kClearlyBefore = 1e-3;
/// How much faster the accepted suboptimality grows for a path that stops at the horizon: that is tried again
/// in the next round anyway.
constexpr double kRestGrowth = 10.0;

}  // namespace

/// The main loop; see the pseudo-code in the header.
Search::Outcome Search::run(Pass pass) {
  if (!begin(pass)) return stopped_ ? Outcome::stopped : Outcome::exhausted;
  label_start();
  for (int step = 1; state_.goal_label == LabelId::none; ++step) {
    if (state_.open.empty()) {
      if (finish_at_rest()) break;
      return state_.incomplete ? Outcome::incomplete : Outcome::exhausted;
    }
    if ((step % kStopStride == 0 || is_costly_) && stop_.met()) return Outcome::stopped;
    if (expansions_ >= pause_) {
      if (expansions_ >= limits_.max_expansions) {
        if (finish_at_rest()) break;
        return Outcome::stopped;
      }
      if (limits_.no_path_test->no_path(expansions_)) return Outcome::exhausted;
      pause_ = std::min(limits_.max_expansions, 2 * expansions_);
    }
    if (goal_entry_suffices()) {
      settle(state_.open[state_.best_goal_entry]);
      break;
    }
    if (rest_suffices() && finish_at_rest()) break;

    // Pop the entry with the smallest f.
    const double f = state_.open.min_f();
    OpenEntry entry = state_.open.pop();
    if (entry.timed()) {
      if (state_.dominance.is_dominated(entry.timed_arrival)) continue;
    } else {
      Edge& edge = state_.edges[entry.edge];
      const Move& move = edge.move(entry.kind);
      if (entry.kind == EdgeKind::shortcut) test_sight(edge);
      if (entry.next_interval_follows) offer_from(entry.edge, entry.interval + 1);
      // An arrival that dominates a shortcut also dominates the local edge.
      if (is_dominated(entry.interval, entry.arrival, move.heading, f)) continue;

      // Time the edge against the reservations.
      const double lower_bound = entry.arrival;
      const auto departure = earliest_departure(entry);
      if (departure) {
        entry.departure = *departure;
        entry.arrival = *departure + move.duration;
      }
      if (!departure || entry.arrival > lower_bound + kSameTime) {
        if (entry.kind == EdgeKind::shortcut) offer(entry.edge, EdgeKind::local, entry.interval, false);
        if (departure) push_timed(entry, f);
        continue;
      }
      state_.dominance.add(entry.interval, entry.arrival, move.heading);
    }

    const LabelId label = settle(entry);
    if (state_.goal_label == LabelId::none) expand(label);
  }
  return Outcome::found;
}

/// Offers the moves to all neighbours, and the service at the goal of the stage.
void Search::expand(LabelId id) {
  ++expansions_;
  if (last_stage_ > 0 && serve(id)) return;
  const Label& label = state_.labels[id];
  const int before = label.by_translation ? place_at(label.parent).vertex : -1;
  const bool reversed = label.reverse;
  const int stage = place_at(id).stage;
  const Vertices& view = vertices(stage);
  if (view.any_angle()) offer_goal(id);
  view.for_each_neighbour(place_at(id).vertex, [&](int neighbour) {
    if (!view.allow(place_at(id).vertex, neighbour)) return;
    const PlaceId target = place_of(neighbour, stage);
    if (state_.places[target].never_safe()) return;
    // A shortcut replaces two moves forwards, or two backwards.
    const bool with_shortcut = view.any_angle() && before >= 0 && neighbour != before;
    const int interval = state_.places[target].first_interval;
    offer_from(add_edge(id, target, with_shortcut && !reversed, false), interval);
    if (motion_.may_reverse) offer_from(add_edge(id, target, with_shortcut && reversed, true), interval);
  });
}

/// If the label is at the goal of a stage before the last one, offers its service. Returns true if nothing
/// else is worth while, because the service takes no time or the robot may stay until it ends.
bool Search::serve(LabelId id) {
  const Label label = state_.labels[id];
  const Place place = state_.places[label.place];
  const Stage& stage = state_.stages[place.stage];
  if (place.vertex != stage.goal.vertex || place.stage == last_stage_) return false;
  const ServiceStop stop = service_stop(label, stage, space_);
  const double t_end = std::max(stop.t_end, label.arrival);
  const double safe_until = state_.intervals[label.interval].end;
  if (t_end > safe_until) return false;
  if (changes_radius_) {
    const bool is_offered = serve_with_other_intervals(id, stop);
    return is_offered && (safe_until == kForever || place.is_window);
  }
  const PlaceId next = place_of(place.vertex, place.stage + 1);
  const int interval = state_.places[next].first_interval + label.interval - place.first_interval;
  Move at_rest;
  at_rest.heading = stop.heading;
  const EdgeId edge = state_.edges.push_back({at_rest, {}, id, next, Edge::Sight::blocked});
  push_timed({t_end, stop.t_rest, edge, interval, ArrivalId::none, EdgeKind::service, false},
             evaluate(next, interval, t_end, stop.heading).f);
  return safe_until == kForever || (t_end == label.arrival && stop.heading == label.heading);
}

/// The same for a robot whose radius changes: the next stage may have other intervals there. One of them has
/// to contain the end of the service. Returns whether one does.
bool Search::serve_with_other_intervals(LabelId id, const ServiceStop& stop) {
  const Label label = state_.labels[id];
  const int stage = place_at(id).stage + 1;
  const Stage& next_stage = state_.stages[stage];
  const int vertex = next_stage.is_rest
                         ? next_stage.goal.vertex
                         : next_stage.vertices->goals()[static_cast<std::size_t>(stage - 1)].vertex;
  const PlaceId next = place_of(vertex, stage);
  const double t_end = std::max(stop.t_end, label.arrival);
  Move at_rest;
  at_rest.heading = stop.heading;
  const EdgeId edge = state_.edges.push_back({at_rest, {}, id, next, Edge::Sight::blocked});
  bool is_offered = false;
  for (int k = state_.places[next].first_interval; k < state_.places[next].end_interval; ++k) {
    const SafeInterval safe = state_.intervals[k];
    const bool contains = safe.begin <= stop.t_end + kRoundingOfTimes && t_end <= safe.end;
    if (!contains || (next_stage.is_rest && safe.end != kForever)) continue;
    push_timed({std::max(t_end, safe.begin), stop.t_rest, edge, k, ArrivalId::none, EdgeKind::service, false},
               evaluate(next, k, t_end, stop.heading).f);
    is_offered = true;
  }
  return is_offered;
}

/// If the goal of the stage is in sight, offers the straight move there; to the last goal in the interval in
/// which the robot may stay.
void Search::offer_goal(LabelId from) {
  const PlaceId place = state_.labels[from].place;
  if (place == state_.goal || !state_.places[place].estimate.straight) return;
  // A long move beyond the horizon would be in the way of others that rest there.
  if (state_.labels[from].arrival + state_.places[place].estimate.seconds > limits_.horizon) return;
  offer_goal(from, false);
  if (motion_.may_reverse) offer_goal(from, true);
}

void Search::offer_goal(LabelId from, bool reverse) {
  const int stage = place_at(from).stage;
  if (stage != last_stage_) {
    const PlaceId goal = goal_of(stage);
    return offer_from(add_edge(from, goal, false, reverse), state_.places[goal].first_interval);
  }
  if (state_.places[state_.goal].never_safe()) return;
  const int last = state_.places[state_.goal].end_interval - 1;
  offer(add_edge(from, state_.goal, false, reverse), EdgeKind::local, last, false);
}

/// Offers the move into the first safe interval of the edge's target, from `interval` on, that the shortcut
/// or the local edge can reach. The next one is offered when this move is popped.
void Search::offer_from(EdgeId id, int interval) {
  const Edge& edge = state_.edges[id];
  const bool shortcut = edge.shortcut_sight != Edge::Sight::blocked;
  double latest = edge.local.latest + edge.local.duration;
  if (shortcut) latest = std::max(latest, edge.shortcut.latest + edge.shortcut.duration);
  const int end = state_.places[edge.target].end_interval;
  for (; interval < end && state_.intervals[interval].begin <= latest; ++interval) {
    if (shortcut && offer(id, EdgeKind::shortcut, interval, true)) return;
    if (offer(id, EdgeKind::local, interval, true)) return;
  }
}

/// Pushes a move with the lower bound of its arrival. Returns false if it is impossible, too expensive or
/// dominated.
inline bool Search::offer(EdgeId id, EdgeKind kind, int interval, bool next_interval_follows) {
  const Edge& edge = state_.edges[id];
  const Move& move = edge.move(kind);
  const double departure = EdgeTiming::lower_bound(move, state_.intervals[interval]);
  if (departure == kForever) return false;
  const double arrival = departure + move.duration;
  const Evaluation evaluation = evaluate(edge.target, interval, arrival, move.heading);
  if (!(evaluation.cost < limits_.bound)) return false;
  if (is_dominated(interval, arrival, move.heading, evaluation.f)) return false;
  state_.open.push({arrival, departure, id, interval, ArrivalId::none, kind, next_interval_follows},
                   evaluation.f, evaluation.h);
  return true;
}

/// Pushes a move again that arrives later than its lower bound, unless it is dominated or too expensive.
/// From now on it takes part in dominance.
void Search::push_timed(OpenEntry entry, double f_lower_bound) {
  const Edge& edge = state_.edges[entry.edge];
  const double heading = edge.move(entry.kind).heading;
  if (is_dominated(entry.interval, entry.arrival, heading, f_lower_bound)) return;
  const Evaluation evaluation = evaluate(edge.target, entry.interval, entry.arrival, heading);
  if (!(evaluation.cost < limits_.bound)) return;
  entry.timed_arrival = state_.dominance.add(entry.interval, entry.arrival, heading);
  const EntryId id = state_.open.push(entry, evaluation.f, evaluation.h);
  if (is_final(edge.target, entry.interval) && evaluation.cost < state_.best_goal_cost) {
    state_.best_goal_entry = id;
    state_.best_goal_cost = evaluation.cost;
  }
}

/// Turns an entry into a label.
LabelId Search::settle(const OpenEntry& entry) {
  const Edge& edge = state_.edges[entry.edge];
  return add_label({entry.arrival, edge.move(entry.kind).heading, entry.departure,
                    source_of(edge, entry.kind), edge.target, entry.interval, entry.kind != EdgeKind::service,
                    edge.move(entry.kind).reverse});
}

/// Adds a label. If it is in the last safe interval of the goal, it is the result.
LabelId Search::add_label(const Label& label) {
  const LabelId id = state_.labels.push_back(label);
  if (is_final(label.place, label.interval)) {
    state_.goal_label = id;
  } else if (has_horizon() && may_rest_at(label)) {
    const double end = std::max(label.arrival, limits_.horizon);
    const Evaluation evaluation = evaluate(label.place, label.interval, end, label.heading);
    if (evaluation.f < state_.best_rest && evaluation.cost < limits_.bound) {
      state_.best_rest = evaluation.f;
      state_.rest_label = id;
    }
    // Its f is the smallest of all; what follows it lies beyond the horizon.
    if (label.arrival >= limits_.horizon) state_.goal_label = state_.rest_label;
  }
  return id;
}

/// Whether the robot may stay for good in this label. A rest in the pose of a goal at which the radius
/// changes would serve it.
bool Search::may_rest_at(const Label& label) const {
  if (state_.intervals[label.interval].end != kForever) return false;
  if (!changes_radius_) return true;
  const Place& place = state_.places[label.place];
  const Stage& stage = state_.stages[place.stage];
  const Position goal = stage.vertices->position(stage.goal.vertex);
  return !place.is_window && (place.position - goal).norm() > kContactTolerance;
}

/// Whether no entry promises much more than the best label to rest at. What is accepted relates to the time
/// up to the horizon, as the way beyond it is the same for all.
bool Search::rest_suffices() const {
  if (state_.rest_label == LabelId::none) return false;
  const double growth = kRestGrowth * limits_.suboptimality_growth * static_cast<double>(expansions_);
  return state_.best_rest <= state_.open.min_f() + growth * limits_.horizon;
}

/// Ends the path at the best label to rest at, if there is one.
bool Search::finish_at_rest() {
  state_.goal_label = state_.rest_label;
  return state_.goal_label != LabelId::none;
}

EdgeId Search::add_edge(LabelId via, PlaceId target, bool with_shortcut, bool reverse) {
  const Move local = move_between(via, target, reverse);
  Move shortcut = with_shortcut ? move_between(state_.labels[via].parent, target, reverse) : Move{};
  // Past a slow zone, the way round may be the faster one.
  with_shortcut =
      with_shortcut && !(vertices_.limit_speeds() &&
                         shortcut.ready + shortcut.duration > local.ready + local.duration + kSameTime);
  if (!with_shortcut) shortcut = Move{};
  return state_.edges.push_back(
      {local, shortcut, via, target, with_shortcut ? Edge::Sight::unknown : Edge::Sight::blocked});
}

inline Move Search::move_between(LabelId from, PlaceId target, bool reverse) const {
  if (changes_radius_) return move_with_radius(from, target, reverse);
  const Label& label = state_.labels[from];
  return move_within(state_.intervals[label.interval], vertices_, label, target, reverse);
}

/// The same for a robot whose radius changes.
Move Search::move_with_radius(LabelId from, PlaceId target, bool reverse) const {
  const Label& label = state_.labels[from];
  SafeInterval interval = state_.intervals[label.interval];
  interval.end = latest_departure(from);
  return move_within(interval, vertices(place_at(from).stage), label, target, reverse);
}

/// The same from a label that the robot leaves within this interval, by the vertices of its stage.
inline Move Search::move_within(const SafeInterval& interval, const Vertices& of_stage, const Label& label,
                                PlaceId target, bool reverse) const {
  const MoveSource source{label.arrival, label.heading, label.by_translation, label.reverse, interval};
  const Displacement d = of_stage.between(state_.places[label.place].vertex, state_.places[target].vertex);
  Move move = timing_.move(source, d.heading, d.length, reverse);
  if (vertices_.limit_speeds()) limit_speeds(move, label, target);
  return move;
}

/// Times the move at the speeds that zones allow.
void Search::limit_speeds(Move& move, const Label& from, PlaceId target) const {
  const Position& here = state_.places[from.place].position;
  move.duration = zones_->translation_time(here, state_.places[target].position);
  move.ready = from.arrival + angle_between(from.heading, move.heading) / zones_->angular_speed_at(here) +
               motion_.wait_before_move;
}

/// Of a robot whose radius changes. A rest in the pose of a goal serves it as soon as it is long enough,
/// whatever the search has in mind: the robot leaves before, or after the service.
double Search::latest_departure(LabelId from) const {
  const Label& label = state_.labels[from];
  const Place& place = place_at(from);
  const double safe_until = state_.intervals[label.interval].end;
  if (place.stage + 1 >= static_cast<int>(space_.goal_count())) return safe_until;
  const Stage& stage = state_.stages[place.stage];
  const Position goal = stage.vertices->position(stage.goal.vertex);
  if ((place.position - goal).norm() > kContactTolerance) return safe_until;
  return std::min(safe_until, service_stop(label, stage, space_).t_end - kClearlyBefore);
}

/// Labels and expands the start, unless the robot cannot be there or the goal is out of bound.
void Search::label_start() {
  const PlaceId start = place_of(vertices_.start(), 0);
  const double t_begin = space_.itinerary().t_begin;
  const int end = state_.places[start].end_interval;
  int interval = state_.places[start].first_interval;
  while (interval < end && state_.intervals[interval].end < t_begin) ++interval;
  if (interval == end || !state_.intervals[interval].contains(t_begin)) return;
  // A robot that may stay where it begins for good rests there at once, whatever the start delay.
  const double t = is_final(start, interval) ? t_begin : t_begin + limits_.start_delay;
  if (!state_.intervals[interval].contains(t)) return;
  const double heading = vertices_.start_pose().theta;
  const double served = space_.itinerary().service_done;
  if (!(evaluate(start, interval, t, heading).cost - served < limits_.bound)) return;
  state_.dominance.add(interval, t, heading);
  const LabelId label = add_label({t, heading, t, LabelId::none, start, interval, false, false});
  if (state_.goal_label == LabelId::none) expand(label);
}

/// Returns whether the cheapest timed path to the goal is within the suboptimality bound.
bool Search::goal_entry_suffices() const {
  if (state_.best_goal_entry == EntryId::none) return false;
  const double suboptimality =
      limits_.suboptimality + limits_.suboptimality_growth * static_cast<double>(expansions_);
  return state_.best_goal_cost <= (1.0 + suboptimality) * state_.open.min_f();
}

/// The earliest departure that arrives in the entry's interval before the arrival would be dominated; none if
/// there is no such departure, or if obstacles block the shortcut.
std::optional<double> Search::earliest_departure(const OpenEntry& entry) {
  const Edge& edge = state_.edges[entry.edge];
  const Move& move = edge.move(entry.kind);
  SafeInterval target = state_.intervals[entry.interval];
  const double dominated_from = state_.dominance.dominated_from(entry.interval, move.heading);
  if (dominated_from < target.end) {
    target.end = dominated_from;
    state_.incomplete = state_.incomplete || use_slack_;
  }
  if (entry.kind == EdgeKind::shortcut && edge.shortcut_sight == Edge::Sight::blocked) return std::nullopt;
  const Segment path{place_at(source_of(edge, entry.kind)).position, state_.places[edge.target].position};
  return timing_.earliest(move, path, target, state_.stages[state_.places[edge.target].stage].narrower);
}

/// Returns whether the arrival is dominated. Sets `incomplete` if the complete pass may keep it.
inline bool Search::is_dominated(int interval, double arrival, double heading, double f) {
  if (state_.dominance.empty(interval)) return false;
  // The quick pass keeps one label per interval while no path ends before time f, because a goal is not free
  // yet or has to wait. An earlier arrival would gain nothing.
  const bool waiting = pass_ == Pass::quick && f <= state_.release;
  const bool dominated =
      waiting || state_.dominance.dominated_from(interval, heading) <= arrival + kSameTime ||
      (motion_.wait_before_move > 0.0 && state_.dominance.contains(interval, arrival, heading));
  state_.incomplete = state_.incomplete || (dominated && (waiting || use_slack_));
  return dominated;
}

inline Search::Evaluation Search::evaluate(PlaceId place, int interval, double arrival,
                                           double heading) const {
  const double h = to_go(place, heading);
  // An arrival at the goal that is within the suboptimality bound is popped before other entries. Without
  // this, many entries could have the same f as long as the goal is not free.
  if (is_final(place, interval)) {
    const double cost = std::max(arrival + h, state_.stages.back().release);
    return {cost / (1.0 + limits_.suboptimality), h, cost};
  }
  const double cost = std::max(arrival + h, state_.release);
  return {std::max(arrival + limits_.heuristic_weight * h, state_.release), h, cost};
}

/// h: an estimate of the seconds from an arrival to the end of the last service, or to rest in the pose of
/// the last goal if that has none; without other robots.
inline double Search::to_go(PlaceId place, double heading) const {
  const CostToGo::Estimate& estimate = state_.places[place].estimate;
  return state_.places[place].any_heading ? estimate.seconds : estimate.with_rotation(heading, motion_);
}

SearchResult AaSipp::run(std::size_t robot, SearchSpace& space, const SearchLimits& limits,
                         const StopCondition& stop) {
  Search search(table_, robot, space, limits, stop, std::move(state_));
  Search::Outcome outcome = search.run(Search::Pass::quick);
  if (outcome == Search::Outcome::incomplete && limits.thorough) outcome = search.run(Search::Pass::complete);
  SearchResult result;
  if (outcome == Search::Outcome::found) result.trajectory = search.trajectory();
  result.complete = outcome != Search::Outcome::stopped;
  result.expansions = search.expansions();
  state_ = search.take_state();
  return result;
}

}  // namespace fleetplan::core
