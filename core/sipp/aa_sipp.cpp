#include "core/sipp/aa_sipp.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>

#include "core/geometry/tolerance.h"
#include "core/sipp/goals.h"
#include "core/sipp/successors.h"

namespace fleetplan::core {
namespace {

/// Loop steps between two checks of the stop condition.
constexpr std::size_t kStopStride = 32;
/// Goals whose services are looked for between two checks of the stop condition.
constexpr std::size_t kServicesBetweenPolls = 64;
/// How much faster the accepted suboptimality grows for a path that stops at the horizon: that is tried again
/// by the next request anyway.
constexpr double kRestGrowth = 10.0;

enum class Pass : std::uint8_t { quick, complete };

/// f orders the open list; h is the estimated cost to the goal; `cost` estimates the cost of the whole path,
/// without the heuristic weight. Seconds.
struct Evaluation {
  double f;
  double h;
  double cost;
};

/// Where the path ends: the best ends that a pass has found, until one of them is good enough.
class PathEnd {
 public:
  explicit PathEnd(const SearchSettings& settings) : limits_(settings) {}

  void begin() {
    label_ = rest_ = LabelId::none;
    entry_ = EntryId::none;
    entry_cost_ = rest_f_ = kForever;
  }

  bool is_found() const { return label_ != LabelId::none; }
  LabelId label() const { return label_; }
  void set(LabelId label) { label_ = label; }

  /// A timed entry into the interval in which a path ends at the goal, and the cost of that path.
  void offer(EntryId entry, double cost) {
    if (!(cost < entry_cost_)) return;
    entry_ = entry;
    entry_cost_ = cost;
  }
  EntryId best_entry() const { return entry_; }

  /// A label beyond the horizon, at which the robot may rest for good.
  void offer_rest(LabelId label, const Evaluation& evaluation) {
    if (!(evaluation.f < rest_f_ && evaluation.cost < limits_.bound)) return;
    rest_ = label;
    rest_f_ = evaluation.f;
  }
  /// Ends the path at the best label to rest at, if there is one.
  bool rest() {
    label_ = rest_;
    return is_found();
  }

  /// Whether the cheapest timed path to the goal is within the suboptimality bound.
  bool goal_suffices(double min_f, std::int64_t expansions) const {
    if (entry_ == EntryId::none) return false;
    const double growth = limits_.suboptimality_growth * static_cast<double>(expansions);
    return entry_cost_ <= (1.0 + (limits_.suboptimality + growth)) * min_f;
  }
  /// Whether no entry has a clearly smaller f than the best label to rest at. The accepted difference relates
  /// to the time up to the horizon, because the way beyond it is the same for all entries.
  bool rest_suffices(double min_f, std::int64_t expansions) const {
    if (rest_ == LabelId::none) return false;
    const double growth = kRestGrowth * limits_.suboptimality_growth * static_cast<double>(expansions);
    return rest_f_ <= min_f + growth * limits_.horizon;
  }

 private:
  const SearchSettings& limits_;
  LabelId label_ = LabelId::none;
  EntryId entry_ = EntryId::none;
  double entry_cost_ = kForever;
  LabelId rest_ = LabelId::none;
  double rest_f_ = kForever;
};

/// Discards arrivals that others dominate. In the quick pass, also discards arrivals that are hardly better.
class DominatedArrivals {
 public:
  DominatedArrivals(const DominanceTable& table, const Goals& goals, const Body& body)
      : table_(table), goals_(goals), body_(body) {}

  void begin(Pass pass, bool uses_slack) {
    pass_ = pass;
    uses_slack_ = uses_slack;
    may_be_kept_ = false;
  }

  bool discard(int interval, double arrival, double heading, double f) {
    if (table_.empty(interval)) return false;
    // The quick pass keeps one label per interval while no path ends before time f, because a goal is not
    // free yet or has to wait. An earlier arrival would gain nothing.
    const bool waiting = pass_ == Pass::quick && f <= goals_.release();
    const bool dominated = waiting || table_.dominated_from(interval, heading) <= arrival + kSameTime ||
                           (body_.wait_before_move > 0.0 && table_.contains(interval, arrival, heading));
    may_be_kept_ = may_be_kept_ || (dominated && (waiting || uses_slack_));
    return dominated;
  }

  /// The part of a safe interval in which an arrival with this heading is not dominated.
  SafeInterval undominated_part(int interval, double heading, SafeInterval safe) {
    const double dominated_from = table_.dominated_from(interval, heading);
    if (dominated_from < safe.end) {
      safe.end = dominated_from;
      may_be_kept_ = may_be_kept_ || uses_slack_;
    }
    return safe;
  }

  /// Whether one was discarded that the complete pass may keep.
  bool may_be_kept() const { return may_be_kept_; }

 private:
  const DominanceTable& table_;
  const Goals& goals_;
  const Body& body_;
  Pass pass_ = Pass::quick;
  bool uses_slack_ = false;
  bool may_be_kept_ = false;
};

/// The search for one robot; see the pseudo-code in the header.
class Search {
 public:
  /// `exhausted`: the open list is empty. `incomplete`: it is empty, but the quick pass discarded an arrival
  /// that the complete pass may keep. `stopped`: by the stop condition or the limit of expansions.
  enum class Outcome : std::uint8_t { found, exhausted, incomplete, stopped };

  Search(const ReservationTable& table, SearchSpace& space, const SearchSettings& settings,
         const StopCondition& stop, SearchState state)
      : space_(space),
        body_(space.vertices().body()),
        limits_(settings),
        stop_(stop),
        has_slow_queries_(table.is_costly() || body_.linear_inertia.is_limited),
        state_(std::move(state)),
        goals_(space, settings.horizon, state_),
        successors_(table, space, goals_, state_, stop),
        dominated_(state_.dominance, goals_, body_),
        end_(settings),
        next_check_(settings.no_path_test == nullptr
                        ? settings.max_expansions
                        : std::min(settings.max_expansions, SearchSettings::kFirstTest)) {}

  Outcome run(Pass pass);
  Trajectory trajectory() const { return goals_.trajectory_to(end_.label()); }
  std::int64_t expansions() const { return expansions_; }
  SearchState take_state() { return std::move(state_); }

 private:
  bool begin(Pass pass);
  bool can_serve_all();
  void label_start();
  double heading_at_start(PlaceId start) const;
  void expand(LabelId id);
  void offer_from(EdgeId id, int interval);
  bool offer(EdgeId id, MoveKind kind, int interval, bool next_interval_follows);
  bool time_entry(OpenEntry& entry, double f);
  void push_timed(OpenEntry entry, double f_lower_bound);
  LabelId settle(const OpenEntry& entry);
  LabelId add_label(const Label& label);

  Evaluation evaluate(PlaceId id, int interval, double arrival, double heading) const;

  SearchSpace& space_;
  const Body& body_;
  const SearchSettings& limits_;
  const StopCondition& stop_;
  const bool has_slow_queries_;  // of the reservations
  SearchState state_;
  Goals goals_;
  Successors successors_;

  DominatedArrivals dominated_;
  PathEnd end_;
  bool stopped_ = false;         // while a pass was prepared
  std::int64_t expansions_ = 0;  // of all passes
  std::int64_t next_check_;      // of the bounds of effort, after so many expansions
};

Search::Outcome Search::run(Pass pass) {
  if (!begin(pass)) return stopped_ ? Outcome::stopped : Outcome::exhausted;
  label_start();
  StopStride stride(stop_, has_slow_queries_ ? 1 : kStopStride);
  while (!end_.is_found()) {
    if (state_.open.empty()) {
      if (end_.rest()) break;
      return dominated_.may_be_kept() ? Outcome::incomplete : Outcome::exhausted;
    }
    if (stride.met_at_step()) return Outcome::stopped;
    if (expansions_ >= next_check_) {
      if (expansions_ >= limits_.max_expansions) {
        if (end_.rest()) break;
        return Outcome::stopped;
      }
      if (limits_.no_path_test->no_path(expansions_)) return Outcome::exhausted;
      next_check_ = std::min(limits_.max_expansions, 2 * expansions_);
    }
    const double f = state_.open.min_f();
    if (end_.goal_suffices(f, expansions_)) {
      settle(state_.open[end_.best_entry()]);
      break;
    }
    if (end_.rest_suffices(f, expansions_) && end_.rest()) break;

    OpenEntry entry = state_.open.pop();
    if (entry.timed()) {
      if (state_.dominance.is_dominated(entry.timed_arrival)) continue;
    } else {
      if (!time_entry(entry, f)) continue;
      state_.dominance.add(entry.interval, entry.arrival, state_.edges[entry.edge].move(entry.kind).heading);
    }
    const LabelId label = settle(entry);
    if (!end_.is_found()) expand(label);
  }
  return Outcome::found;
}

/// Prepares a pass. Returns false if the stop condition is met, or if a goal is never free long enough. The
/// last goal needs a safe interval without end, unless there is a horizon: then the path may end elsewhere.
bool Search::begin(Pass pass) {
  const bool uses_slack = pass == Pass::quick && limits_.dominance_slack > 0.0;
  dominated_.begin(pass, uses_slack);
  end_.begin();
  state_.clear(static_cast<std::size_t>(space_.vertex_count()));
  const double slack = uses_slack ? limits_.dominance_slack * space_.vertices().lattice().spacing() : 0.0;
  // With the slowest rotations, an arrival that dominates does so in every zone.
  state_.dominance.reset(space_.vertices().times().slowest_body(), body_.translation_time(slack));
  stopped_ = !goals_.begin(stop_);
  if (stopped_ || !goals_.end_at(successors_.goal_of(goals_.last_stage()))) return false;
  return goals_.has_horizon() || can_serve_all();
}

/// Whether each goal before the last one is free for long enough, at some time.
bool Search::can_serve_all() {
  StopStride stride(stop_, kServicesBetweenPolls);
  for (int k = 0; k < goals_.last_stage(); ++k) {
    stopped_ = stride.met_at_step();
    if (stopped_ || !goals_.can_serve(k, state_.places[successors_.goal_of(k)])) return false;
  }
  return true;
}

/// The heading in which the robot begins; if it may have any, the best one by the estimate.
double Search::heading_at_start(PlaceId start) const {
  if (!space_.any_heading_at_start()) return space_.heading_at_start();
  const CostToGo::Estimate& estimate = state_.places[start].estimate;
  const bool is_ahead = estimate.seconds <= estimate.reverse_seconds;
  return is_ahead ? estimate.heading : opposite_heading(estimate.heading);
}

/// Labels and expands the start, unless the robot cannot be there or the goal is out of bound.
void Search::label_start() {
  const PlaceId start = successors_.place_of(space_.vertices().start(), 0);
  const double t_begin = space_.t_begin();
  const int end = state_.places[start].end_interval;
  int interval = state_.places[start].first_interval;
  while (interval < end && state_.intervals[interval].end < t_begin) ++interval;
  if (interval == end || !state_.intervals[interval].contains(t_begin)) return;
  // A robot that serves all goals where it begins and may stay there for good does so at once, whatever the
  // delay.
  const bool stays = goals_.is_end(start, interval) ||
                     (space_.all_goals_at_start() && state_.intervals[interval].end == kForever);
  const double t = stays ? t_begin : t_begin + limits_.start_delay;
  if (!state_.intervals[interval].contains(t)) return;
  const double heading = heading_at_start(start);
  const double served = space_.service_done();
  if (!(evaluate(start, interval, t, heading).cost - served < limits_.bound)) return;
  state_.dominance.add(interval, t, heading);
  const LabelId label = add_label({t, heading, t, LabelId::none, start, interval, false, false});
  if (!end_.is_found()) expand(label);
}

/// Offers all successors of a label.
void Search::expand(LabelId id) {
  ++expansions_;
  const Successors::Services services = successors_.services_from(id);
  for (const OpenEntry& service : services.entries) {
    const Edge& edge = state_.edges[service.edge];
    push_timed(service, evaluate(edge.target, service.interval, service.arrival, edge.local.heading).f);
  }
  if (services.suffice) return;
  const auto [first, end] = successors_.add_edges(id);
  for (int edge = first; edge < end; ++edge) {
    offer_from(EdgeId{edge}, state_.edges[EdgeId{edge}].from_interval);
  }
}

/// Offers the move into the first safe interval of the edge's target, from `interval` on, that the shortcut
/// or the local move can reach. The next one is offered when this move is popped.
void Search::offer_from(EdgeId id, int interval) {
  const Edge& edge = state_.edges[id];
  const bool shortcut = edge.shortcut_sight != Edge::Sight::blocked;
  double latest = edge.local.latest + edge.local.duration;
  if (shortcut) latest = std::max(latest, edge.shortcut.latest + edge.shortcut.duration);
  const int end = state_.places[edge.target].end_interval;
  for (; interval < end && state_.intervals[interval].begin <= latest; ++interval) {
    if (shortcut && offer(id, MoveKind::shortcut, interval, true)) return;
    if (offer(id, MoveKind::local, interval, true)) return;
  }
}

/// Pushes a move with the lower bound of its arrival. Returns false if it is impossible, too expensive or
/// dominated.
inline bool Search::offer(EdgeId id, MoveKind kind, int interval, bool next_interval_follows) {
  const Edge& edge = state_.edges[id];
  const Move& move = edge.move(kind);
  const double departure = move.earliest_into(state_.intervals[interval]);
  if (departure == kForever) return false;
  const double arrival = departure + move.duration;
  const Evaluation evaluation = evaluate(edge.target, interval, arrival, move.heading);
  if (!(evaluation.cost < limits_.bound)) return false;
  if (dominated_.discard(interval, arrival, move.heading, evaluation.f)) return false;
  state_.open.push({arrival, departure, id, interval, ArrivalId::none, kind, next_interval_follows},
                   evaluation.f, evaluation.h);
  return true;
}

/// Tests an entry with this f against obstacles and reservations. Returns whether its lower bound is exact.
/// If not, pushes what takes its place: the same move with its later arrival, and the local move for a
/// shortcut.
bool Search::time_entry(OpenEntry& entry, double f) {
  Edge& edge = state_.edges[entry.edge];
  const Move& move = edge.move(entry.kind);
  const bool is_shortcut = entry.kind == MoveKind::shortcut;
  if (is_shortcut) successors_.test_sight(edge);
  if (entry.next_interval_follows) offer_from(entry.edge, entry.interval + 1);
  // An arrival that dominates a shortcut also dominates the local move.
  if (dominated_.discard(entry.interval, entry.arrival, move.heading, f)) return false;

  const double lower_bound = entry.arrival;
  const SafeInterval& safe = state_.intervals[entry.interval];
  const auto departure =
      successors_.earliest_departure(entry, dominated_.undominated_part(entry.interval, move.heading, safe));
  if (departure) {
    entry.departure = *departure;
    entry.arrival = *departure + move.duration;
    if (entry.arrival <= lower_bound + kSameTime) return true;
  }
  if (is_shortcut) offer(entry.edge, MoveKind::local, entry.interval, false);
  if (departure) push_timed(entry, f);
  return false;
}

/// Pushes a move again that arrives later than its lower bound, unless it is dominated or too expensive.
/// From now on it takes part in dominance.
void Search::push_timed(OpenEntry entry, double f_lower_bound) {
  const Edge& edge = state_.edges[entry.edge];
  const double heading = edge.move(entry.kind).heading;
  if (dominated_.discard(entry.interval, entry.arrival, heading, f_lower_bound)) return;
  const Evaluation evaluation = evaluate(edge.target, entry.interval, entry.arrival, heading);
  if (!(evaluation.cost < limits_.bound)) return;
  entry.timed_arrival = state_.dominance.add(entry.interval, entry.arrival, heading);
  const EntryId id = state_.open.push(entry, evaluation.f, evaluation.h);
  if (goals_.is_end(edge.target, entry.interval)) end_.offer(id, evaluation.cost);
}

/// Turns an entry into a label.
LabelId Search::settle(const OpenEntry& entry) {
  const Edge& edge = state_.edges[entry.edge];
  return add_label({entry.arrival, edge.move(entry.kind).heading, entry.departure,
                    state_.source_of(edge, entry.kind), edge.target, entry.interval,
                    entry.kind != MoveKind::service, edge.move(entry.kind).reverse});
}

/// Adds a label. If the path may end there, it is the result.
LabelId Search::add_label(const Label& label) {
  const LabelId id = state_.labels.push_back(label);
  if (goals_.is_end(label.place, label.interval)) {
    end_.set(id);
  } else if (goals_.has_horizon() && goals_.may_rest_at(label)) {
    const double t_rest = std::max(label.arrival, limits_.horizon);
    end_.offer_rest(id, evaluate(label.place, label.interval, t_rest, label.heading));
    // Its f is the smallest of all; what follows it lies beyond the horizon.
    if (label.arrival >= limits_.horizon) end_.rest();
  }
  return id;
}

/// h estimates the seconds from an arrival to the end of the last service, without other robots. If the last
/// goal has no service, to rest in its pose.
inline Evaluation Search::evaluate(PlaceId id, int interval, double arrival, double heading) const {
  const Place& place = state_.places[id];
  const double h = place.any_heading ? place.estimate.seconds : place.estimate.with_rotation(heading, body_);
  // An arrival at the goal that is within the suboptimality bound is popped before other entries. Without
  // this, many entries could have the same f as long as the goal is not free.
  if (goals_.is_end(id, interval)) {
    const double cost = std::max(arrival + h, goals_.last_release());
    return {cost / (1.0 + limits_.suboptimality), h, cost};
  }
  const double cost = std::max(arrival + h, goals_.release());
  return {std::max(arrival + limits_.heuristic_weight * h, goals_.release()), h, cost};
}

}  // namespace

SearchResult AaSipp::run(SearchSpace& space, const SearchSettings& settings, const StopCondition& stop) {
  Search search(table_, space, settings, stop, std::move(state_));
  Search::Outcome outcome = search.run(Pass::quick);
  if (outcome == Search::Outcome::incomplete && settings.thorough) outcome = search.run(Pass::complete);
  SearchResult result;
  if (outcome == Search::Outcome::found) result.trajectory = search.trajectory();
  result.complete = outcome != Search::Outcome::stopped;
  result.expansions = search.expansions();
  state_ = search.take_state();
  return result;
}

}  // namespace fleetplan::core
