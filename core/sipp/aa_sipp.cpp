#include "core/sipp/aa_sipp.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "core/geometry/angle.h"
#include "core/geometry/tolerance.h"
#include "core/sipp/label_path.h"

namespace fleetplan::core {
namespace {

/// Loop steps between two checks of the stop condition.
constexpr int kStopStride = 32;

enum class Pass : std::uint8_t { quick, complete };

/// `exhausted`: the open list is empty. `incomplete`: likewise, but the quick pass discarded an arrival that
/// the complete pass may keep. `stopped`: by the stop condition or the limit of expansions.
enum class Outcome : std::uint8_t { found, exhausted, incomplete, stopped };

/// The search for one robot: its inputs and its state. Intervals are indices into SearchState::intervals.
class Search {
 public:
  Search(const ReservationTable& table, std::size_t robot, SearchSpace& space, const SearchLimits& limits,
         const StopCondition& stop, SearchState state)
      : table_(table),
        robot_(robot),
        space_(space),
        motion_(space.vertices().motion()),
        timing_(motion_, table, robot),
        vertices_(space.vertices()),
        last_stage_(static_cast<int>(space.goal_count()) - 1),
        limits_(limits),
        stop_(stop),
        pause_(std::min(limits.max_expansions, first_test(limits))),
        state_(std::move(state)) {}

  Outcome run(Pass pass);
  Trajectory trajectory() const { return trajectory_of(state_, space_); }
  std::int64_t expansions() const { return expansions_; }
  SearchState take_state() { return std::move(state_); }

 private:
  /// f orders the open list; h is the estimated cost to the goal; `cost` estimates the cost of the whole
  /// path, without the heuristic weight. Seconds.
  struct Evaluation {
    double f;
    double h;
    double cost;
  };

  static std::int64_t first_test(const SearchLimits& limits) {
    return limits.no_path_test == nullptr ? limits.max_expansions : SearchLimits::kFirstTest;
  }
  bool begin(Pass pass);
  bool can_serve_all();
  void label_start();
  bool goal_entry_suffices() const;
  LabelId settle(const OpenEntry& entry);
  LabelId add_label(const Label& label);
  void expand(LabelId id);
  bool serve(LabelId id);
  void offer_goal(LabelId from);
  void offer_from(EdgeId id, int interval);
  bool offer(EdgeId id, EdgeKind kind, int interval, bool next_interval_follows);
  void push_timed(OpenEntry entry, double f_lower_bound);

  EdgeId add_edge(LabelId via, PlaceId target, bool with_shortcut);
  Move move_between(LabelId from, PlaceId target) const;
  void test_sight(Edge& edge) const;
  std::optional<double> earliest_departure(const OpenEntry& entry);
  bool is_dominated(int interval, double arrival, double heading, double f);
  Evaluation evaluate(PlaceId place, int interval, double arrival, double heading) const;
  double to_go(PlaceId place, double heading) const;

  PlaceId place_of(int vertex, int stage);
  void append_intervals(Place& place);
  PlaceId goal_of(int stage) { return place_of(state_.stages[stage].goal.vertex, stage); }
  LabelId source_of(const Edge& edge, EdgeKind kind) const {
    return kind == EdgeKind::shortcut ? state_.labels[edge.via].parent : edge.via;
  }
  const Place& place_at(LabelId label) const { return state_.places[state_.labels[label].place]; }
  bool is_final(PlaceId place, int interval) const {
    return place == state_.goal && state_.intervals[interval].end == kForever;
  }

  const ReservationTable& table_;
  const std::size_t robot_;
  SearchSpace& space_;
  const Motion& motion_;
  const EdgeTiming timing_;
  const Vertices& vertices_;
  const int last_stage_;
  const SearchLimits& limits_;
  const StopCondition& stop_;

  const bool is_costly_ = table_.is_costly();
  Pass pass_ = Pass::quick;
  bool use_slack_ = false;
  std::int64_t expansions_ = 0;  // of all passes
  std::int64_t pause_;           // expansions after which the limits are looked at
  SearchState state_;
};

/// The main loop; see the pseudo-code in the header.
Outcome Search::run(Pass pass) {
  if (!begin(pass)) return Outcome::exhausted;
  label_start();
  for (int step = 1; state_.goal_label == LabelId::none; ++step) {
    if (state_.open.empty()) return state_.incomplete ? Outcome::incomplete : Outcome::exhausted;
    if ((step % kStopStride == 0 || is_costly_) && stop_.met()) return Outcome::stopped;
    if (expansions_ >= pause_) {
      if (expansions_ >= limits_.max_expansions) return Outcome::stopped;
      if (limits_.no_path_test->no_path(expansions_)) return Outcome::exhausted;
      pause_ = std::min(limits_.max_expansions, 2 * expansions_);
    }
    if (goal_entry_suffices()) {
      settle(state_.open[state_.best_goal_entry]);
      break;
    }

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
  const int stage = place_at(id).stage;
  if (vertices_.any_angle()) offer_goal(id);
  vertices_.for_each_neighbour(place_at(id).vertex, [&](int neighbour) {
    const PlaceId target = place_of(neighbour, stage);
    if (state_.places[target].never_safe()) return;
    const bool with_shortcut = vertices_.any_angle() && before >= 0 && neighbour != before;
    offer_from(add_edge(id, target, with_shortcut), state_.places[target].first_interval);
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
  const PlaceId next = place_of(place.vertex, place.stage + 1);
  const int interval = state_.places[next].first_interval + label.interval - place.first_interval;
  Move at_rest;
  at_rest.heading = stop.heading;
  const EdgeId edge = state_.edges.push_back({at_rest, {}, id, next, Edge::Sight::blocked});
  push_timed({t_end, stop.t_rest, edge, interval, ArrivalId::none, EdgeKind::service, false},
             evaluate(next, interval, t_end, stop.heading).f);
  return safe_until == kForever || (t_end == label.arrival && stop.heading == label.heading);
}

/// If the goal of the stage is in sight, offers the straight move there; to the last goal in the interval in
/// which the robot may stay.
void Search::offer_goal(LabelId from) {
  const PlaceId place = state_.labels[from].place;
  const int stage = state_.places[place].stage;
  if (place == state_.goal || !state_.places[place].estimate.straight) return;
  if (stage != last_stage_) {
    const PlaceId goal = goal_of(stage);
    return offer_from(add_edge(from, goal, false), state_.places[goal].first_interval);
  }
  const int last = state_.places[state_.goal].end_interval - 1;
  offer(add_edge(from, state_.goal, false), EdgeKind::local, last, false);
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
                    source_of(edge, entry.kind), edge.target, entry.interval,
                    entry.kind != EdgeKind::service});
}

/// Adds a label. If it is in the last safe interval of the goal, it is the result.
LabelId Search::add_label(const Label& label) {
  const LabelId id = state_.labels.push_back(label);
  if (is_final(label.place, label.interval)) state_.goal_label = id;
  return id;
}

EdgeId Search::add_edge(LabelId via, PlaceId target, bool with_shortcut) {
  const Move local = move_between(via, target);
  const Move shortcut = with_shortcut ? move_between(state_.labels[via].parent, target) : Move{};
  return state_.edges.push_back(
      {local, shortcut, via, target, with_shortcut ? Edge::Sight::unknown : Edge::Sight::blocked});
}

inline Move Search::move_between(LabelId from, PlaceId target) const {
  const Label& label = state_.labels[from];
  const MoveSource source{label.arrival, label.heading, label.by_translation,
                          state_.intervals[label.interval]};
  const Displacement d = vertices_.between(place_at(from).vertex, state_.places[target].vertex);
  return timing_.move(source, d.heading, d.length);
}

/// Prepares a pass. Returns false if the last goal has no safe interval without end, or another one has none
/// that is long enough.
bool Search::begin(Pass pass) {
  pass_ = pass;
  use_slack_ = pass == Pass::quick && limits_.dominance_slack > 0.0;
  state_.clear();
  state_.place_of_vertex.resize(
      std::max(state_.place_of_vertex.size(), static_cast<std::size_t>(vertices_.count())), PlaceId::none);
  const double slack = use_slack_ ? limits_.dominance_slack * vertices_.spacing() : 0.0;
  state_.dominance.reset(motion_, motion_.translation_time(slack));
  state_.stages = stages_of(space_, stop_);
  state_.goal = goal_of(last_stage_);
  const Place& goal = state_.places[state_.goal];
  if (goal.never_safe()) return false;
  const SafeInterval& last = state_.intervals[goal.end_interval - 1];
  set_releases(state_.stages, last.begin);
  state_.release = state_.stages[0].release;
  return last.end == kForever && can_serve_all();
}

/// Whether each goal before the last one is free for long enough, at some time.
bool Search::can_serve_all() {
  for (int k = 0; k < last_stage_; ++k) {
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
  const LabelId label = add_label({t, heading, t, LabelId::none, start, interval, false});
  if (state_.goal_label == LabelId::none) expand(label);
}

/// Returns whether the cheapest timed path to the goal is within the suboptimality bound.
bool Search::goal_entry_suffices() const {
  if (state_.best_goal_entry == EntryId::none) return false;
  const double suboptimality =
      limits_.suboptimality + limits_.suboptimality_growth * static_cast<double>(expansions_);
  return state_.best_goal_cost <= (1.0 + suboptimality) * state_.open.min_f();
}

/// Tests the shortcut against obstacles, once.
void Search::test_sight(Edge& edge) const {
  if (edge.shortcut_sight != Edge::Sight::unknown) return;
  const int from = place_at(source_of(edge, EdgeKind::shortcut)).vertex;
  const bool free = vertices_.in_sight(from, state_.places[edge.target].vertex);
  edge.shortcut_sight = free ? Edge::Sight::free : Edge::Sight::blocked;
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
  return timing_.earliest(move, path, target);
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
  if (state_.places[place].any_heading) return estimate.seconds;
  return estimate.seconds + motion_.rotation_time(heading, estimate.heading);
}

/// The place of a vertex in a stage, with its safe intervals; computed when it is reached for the first time.
PlaceId Search::place_of(int vertex, int stage) {
  PlaceId& latest = state_.place_of_vertex[vertex];
  PlaceId known = latest;
  while (known != PlaceId::none && state_.places[known].stage != stage) {
    known = state_.places[known].other_stage;
  }
  if (known != PlaceId::none) return known;
  Place place{vertex, stage, vertices_.position(vertex), {}, false, state_.intervals.next_index(), 0, latest};
  const Stage& at = state_.stages[stage];
  if (vertex != at.goal.vertex) {
    place.estimate = space_.cost_to_go(static_cast<std::size_t>(stage)).from(vertex, stop_);
    place.estimate.seconds += at.after;
  } else {
    place.estimate = {at.after, at.goal.heading.value_or(0.0), false};
    place.any_heading = !at.goal.heading;
  }
  append_intervals(place);
  latest = state_.places.push_back(place);
  return latest;
}

/// Those of the vertex in another stage are the same.
void Search::append_intervals(Place& place) {
  if (place.other_stage != PlaceId::none) {
    const Place& other = state_.places[place.other_stage];
    for (int k = other.first_interval; k < other.end_interval; ++k) {
      state_.intervals.push_back(SafeInterval(state_.intervals[k]));
    }
  } else {
    for (const SafeInterval& safe : table_.safe_intervals(robot_, place.position)) {
      state_.intervals.push_back(safe);
    }
  }
  place.end_interval = state_.intervals.next_index();
  state_.dominance.set_interval_count(state_.intervals.size());
}

}  // namespace

SearchResult AaSipp::run(std::size_t robot, SearchSpace& space, const SearchLimits& limits,
                         const StopCondition& stop) {
  Search search(table_, robot, space, limits, stop, std::move(state_));
  Outcome outcome = search.run(Pass::quick);
  if (outcome == Outcome::incomplete && limits.thorough) outcome = search.run(Pass::complete);
  SearchResult result;
  if (outcome == Outcome::found) result.trajectory = search.trajectory();
  result.complete = outcome != Outcome::stopped;
  result.expansions = search.expansions();
  state_ = search.take_state();
  return result;
}

}  // namespace fleetplan::core
