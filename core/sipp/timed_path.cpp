#include "core/sipp/timed_path.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/elementary_functions.h"
#include "core/geometry/tolerance.h"
#include "core/sipp/moves.h"

namespace fleetplan::core {

namespace {

/// Stops between two checks of the stop condition, where queries are quick.
constexpr std::size_t kStopsBetweenPolls = 16;

}  // namespace

TimedPath::TimedPath(const Instance& instance, const ReservationTable& table, std::size_t robot,
                     const StopCondition& stop)
    : table_(table),
      stop_(stop),
      stride_(stop_,
              table.is_costly() || instance.body(robot).linear_inertia.is_limited ? 1 : kStopsBetweenPolls),
      robot_(robot),
      view_(instance.views(robot)[0]),
      itinerary_(instance.itinerary(robot)),
      times_(view_.body, view_.zones.get()),
      may_be_timed_(may_be_timed(instance, robot)) {}

bool TimedPath::may_be_timed(const Instance& instance, std::size_t robot) {
  const Itinerary& itinerary = instance.itinerary(robot);
  return !instance.views(robot).change() && !instance.options().horizon && !itinerary.yields() &&
         !itinerary.is_parked();
}

bool TimedPath::follow(const Trajectory& trajectory) {
  constexpr double kAsFast = 1e-6;  // seconds; far above rounding
  if (!may_be_timed_ || !set_stops(trajectory)) return false;
  ++timed_count_;
  begin(stops_.front());
  for (std::size_t k = 1; k < stops_.size(); ++k) {
    set_safe_intervals(stops_[k - 1], stops_[k], k + 1 == stops_.size());
    if (!arrive(stops_[k - 1], stops_[k], trajectory.cost + kAsFast)) return false;
  }
  trajectory_ = trajectory_of(stops_);
  return true;
}

/// Takes the stops from a trajectory: between its moves, but where one continues the other. Of a move of no
/// length, which leads to a vertex, only the end is taken.
bool TimedPath::set_stops(const Trajectory& trajectory) {
  const std::size_t committed = itinerary_.committed.moves.size();
  if (trajectory.stops_at || trajectory.moves.size() <= committed) return false;
  stops_.assign(1, Stop{});
  stops_.front().position = trajectory.moves[committed].path.from;
  if (!is_same_position(stops_.front().position, itinerary_.pose.position)) return false;
  std::vector<double> arrivals{itinerary_.t_begin};
  for (std::size_t k = committed; k < trajectory.moves.size(); ++k) {
    const TimedMove& move = trajectory.moves[k];
    const bool has_length = !is_same_position(move.path.from, move.path.to);
    if (has_length && (stops_.size() == 1 || !move.continues)) {
      stops_.emplace_back();
      arrivals.emplace_back();
      stops_.back().reverse = move.reverse;
    }
    if (stops_.size() == 1) continue;
    stops_.back().position = move.path.to;
    arrivals.back() = move.t_end;
  }
  return stops_.size() > 1 && set_goals(trajectory, arrivals);
}

/// Says at which stops the goals are served, by the visits. `arrivals`: at the stops, seconds.
bool TimedPath::set_goals(const Trajectory& trajectory, const std::vector<double>& arrivals) {
  const auto serve = [&](std::size_t goal, std::size_t stop) {
    const bool is_there =
        (stops_[stop].position - itinerary_.goals[goal].position).norm() <= kContactTolerance;
    stops_[stop].goals_end = goal + 1;
    return stop > 0 && is_there;
  };
  std::size_t goal = 0;
  for (const Visit& visit : trajectory.visits) {
    const auto later = std::upper_bound(arrivals.begin(), arrivals.end(), visit.t_arrive + kSameTime);
    const bool is_next = goal + 1 < itinerary_.goals.size() && visit.goal == itinerary_.first_goal + goal;
    if (!is_next || later == arrivals.begin()) return false;
    if (!serve(goal++, static_cast<std::size_t>(later - arrivals.begin()) - 1)) return false;
  }
  if (goal + 1 != itinerary_.goals.size() || !serve(goal, stops_.size() - 1)) return false;
  stops_.front().heading_after = itinerary_.pose.theta;
  for (std::size_t k = 1; k < stops_.size(); ++k) {
    stops_[k].goals_end = std::max(stops_[k].goals_end, stops_[k - 1].goals_end);
    if (is_same_position(stops_[k - 1].position, stops_[k].position)) return false;
    set_move(stops_[k - 1], stops_[k]);
  }
  set_least_left(stops_.size());
  return true;
}

bool TimedPath::is_bend(std::size_t stop) const {
  return stop > 0 && stop + 1 < stops_.size() && stops_[stop - 1].goals_end == stops_[stop].goals_end &&
         stops_[stop].reverse == stops_[stop + 1].reverse;
}

void TimedPath::set_move(const Stop& from, Stop& to) const {
  const Position way = to.position - from.position;
  const double heading = heading_of(way);
  to.heading = to.reverse ? opposite_heading(heading) : heading;
  to.duration = times_.translation_time(way.norm(), [&] { return Segment{from.position, to.position}; });
  to.heading_after = to.heading;
  for (std::size_t goal = from.goals_end; goal < to.goals_end; ++goal) {
    to.heading_after = itinerary_.goals[goal].theta.value_or(to.heading_after);
  }
}

/// Seconds from when the robot is ready to leave a stop to its departure, at least.
double TimedPath::preparation(const Stop& from, const Stop& to) const {
  return times_.rotation_time(from.position, from.heading_after, to.heading) + view_.body.wait_before_move;
}

/// When the goals of a stop are served if the robot arrives there at `t`, seconds. Appends the visits to
/// them, if wanted.
double TimedPath::served(const Stop& from, const Stop& to, double t, std::vector<Visit>* visits) const {
  double heading = to.heading;
  // Bounded: the goals of one stop.
  for (std::size_t k = from.goals_end; k < to.goals_end; ++k) {
    const Goal& goal = itinerary_.goals[k];
    const double heading_there = goal.theta.value_or(heading);
    const double t_rest = t + times_.rotation_time(to.position, heading, heading_there);
    t = goal.service_end(t_rest);
    heading = heading_there;
    if (visits != nullptr) visits->push_back({itinerary_.first_goal + k, t_rest, t});
  }
  return t;
}

/// Seconds from the arrival at a stop to the end of the path, at least. `before`: the stop before, whose
/// goals are served; `next`: null at the end.
double TimedPath::least_left(const Stop& before, const Stop& stop, const Stop* next) const {
  double left = next != nullptr ? preparation(stop, *next) + next->duration + next->least_left : 0.0;
  double heading = stop.heading;
  // Bounded: the goals of one stop.
  for (std::size_t k = before.goals_end; k < stop.goals_end; ++k) {
    const Goal& goal = itinerary_.goals[k];
    const double heading_there = goal.theta.value_or(heading);
    left += times_.rotation_time(stop.position, heading, heading_there) + goal.service;
    heading = heading_there;
  }
  return left;
}

/// Sets the least rest of the path after each of the first `count` stops. The next stop's value, if there is
/// one, is already set.
void TimedPath::set_least_left(std::size_t count) {
  // Bounded: the stops of one path.
  for (std::size_t k = count; k-- > 0;) {
    Stop& stop = stops_[k];
    const Stop* next = k + 1 < stops_.size() ? &stops_[k + 1] : nullptr;
    stop.least_left = least_left(k > 0 ? stops_[k - 1] : stop, stop, next);
  }
}

/// With which the robot leaves a stop, see SearchSpace::footprint().
Footprint TimedPath::footprint(const Stop& stop) const {
  return {robot_, view_.body.radius, stop.goals_end > 0};
}

void TimedPath::set_safe_intervals(const Stop& from, Stop& to, bool is_last) const {
  const double distance = (to.position - itinerary_.pose.position).norm();
  const double earliest = itinerary_.t_begin + distance / view_.body.linear_speed;
  to.safe = table_.safe_intervals(footprint(from), to.position, earliest);
  if (!is_last || to.safe.empty()) return;
  to.safe.erase(to.safe.begin(), to.safe.end() - 1);
  if (to.safe.front().end != kForever) to.safe.clear();
}

void TimedPath::begin(Stop& stop) const {
  const double t = itinerary_.t_begin;
  stop.arrivals.clear();
  for (const SafeInterval& safe : table_.safe_intervals(footprint(stop), stop.position, t)) {
    if (stop.arrivals.empty() && safe.contains(t)) stop.arrivals.push_back({t, t, t, 0, safe});
  }
}

/// Finds the earliest arrivals at a stop from which the path can end before `bound`. Returns whether there
/// are any.
bool TimedPath::arrive(const Stop& from, Stop& to, double bound) {
  if (stride_.met_at_step()) return false;
  const Segment way{from.position, to.position};
  const double preparation = this->preparation(from, to);
  to.arrivals.clear();
  // Bounded: the safe intervals of two positions, which the reservations of other robots divide.
  for (const SafeInterval& safe : to.safe) {
    Arrival best{.t = bound - to.least_left, .safe = safe};
    bool is_found = false;
    for (const Arrival& arrival : from.arrivals) {
      const double t_min = std::max(arrival.ready + preparation, safe.begin - to.duration);
      const double t_max = std::min(arrival.safe.end, safe.end - to.duration) + kSameTime;
      if (t_min > t_max || t_min + to.duration >= best.t) continue;
      const auto departure =
          earliest_departure(table_, footprint(from), times_, way, to.duration, t_min, t_max);
      if (!departure || *departure + to.duration >= best.t) continue;
      is_found = true;
      best.t = *departure + to.duration;
      best.departure = *departure;
      best.from = static_cast<std::size_t>(&arrival - from.arrivals.data());
    }
    best.ready = served(from, to, best.t);
    const bool is_served = best.ready <= safe.end + kSameTime && best.ready < bound;
    if (is_found && is_served) to.arrivals.push_back(best);
  }
  return !to.arrivals.empty();
}

/// Whether an arrival in a safe interval of the stop is sooner than now.
bool TimedPath::is_sooner(const Stop& tried, const Stop& now) const {
  return std::any_of(tried.arrivals.begin(), tried.arrivals.end(), [&](const Arrival& arrival) {
    return std::none_of(now.arrivals.begin(), now.arrivals.end(), [&](const Arrival& other) {
      return other.safe.begin == arrival.safe.begin && other.t <= arrival.t + kSameTime;
    });
  });
}

/// Times the stops that would come after stop first - 1, in tried_. Returns how many they are; none if that
/// fails. What most tries fail for is asked before stops are copied.
std::optional<std::size_t> TimedPath::try_replace(std::size_t first, std::size_t count,
                                                  const std::optional<Position>& by, double bound) {
  const std::size_t next = first + count;
  const std::size_t inserted = by ? 1 : 0;
  const std::size_t tried_count = inserted + stops_.size() - next;
  if (tried_.size() < tried_count) tried_.resize(tried_count);
  const Stop& from = stops_[first - 1];
  if (is_same_position(from.position, by.value_or(stops_[next].position))) return {};
  if (by) {
    if (is_same_position(*by, stops_[next].position)) return {};
    Stop& bend = tried_.front();
    bend.position = *by;
    bend.reverse = stops_[first].reverse;
    bend.goals_end = from.goals_end;
    set_move(from, bend);
  }
  Stop& end = tried_[inserted];  // the move to this stop is the last new move
  end = stops_[next];
  const Stop& before_end = by ? tried_.front() : from;
  set_move(before_end, end);
  end.least_left = least_left(before_end, end, next + 1 < stops_.size() ? &stops_[next + 1] : nullptr);
  if (by) tried_.front().least_left = least_left(from, tried_.front(), &end);
  const Stop& to = tried_.front();
  if (from.arrivals.front().ready + preparation(from, to) + to.duration + to.least_left >= bound) return {};
  if (!view_.allows(from.position, to.position)) return {};
  if (by && !view_.allows(to.position, end.position)) return {};
  ++timed_count_;
  if (by) set_safe_intervals(from, tried_.front(), false);
  // Bounded: the stops of one path.
  for (std::size_t k = 0; k < tried_count; ++k) {
    const Stop* now = k > inserted ? &stops_[next + k - inserted] : nullptr;  // of a move that is not new
    if (now != nullptr) tried_[k] = *now;
    if (!arrive(k > 0 ? tried_[k - 1] : from, tried_[k], bound)) return {};
    if (now != nullptr && !is_sooner(tried_[k], *now)) return {};
  }
  return tried_count;
}

bool TimedPath::replace(std::size_t first, std::size_t count, const std::optional<Position>& by, double bound,
                        const Accept& accept) {
  const auto tried_count = try_replace(first, count, by, bound);
  if (!tried_count) return false;
  std::vector<Stop> stops(stops_.begin(), stops_.begin() + static_cast<std::ptrdiff_t>(first));
  stops.insert(stops.end(), tried_.begin(), tried_.begin() + static_cast<std::ptrdiff_t>(*tried_count));
  Trajectory tried = trajectory_of(stops);
  if (!accept(tried)) return false;
  stops_ = std::move(stops);
  set_least_left(first);
  trajectory_ = std::move(tried);
  return true;
}

Trajectory TimedPath::trajectory_of(const std::vector<Stop>& stops) const {
  Trajectory trajectory = itinerary_.committed;
  if (trajectory.moves.empty()) trajectory.start = stops.front().position;
  std::vector<const Arrival*> arrivals{&stops.back().arrivals.back()};
  for (std::size_t k = stops.size() - 1; k > 0; --k) {
    arrivals.push_back(&stops[k - 1].arrivals[arrivals.back()->from]);
  }
  std::reverse(arrivals.begin(), arrivals.end());
  // Bounded: the stops of one path, the pieces of their moves.
  for (std::size_t k = 1; k < stops.size(); ++k) {
    const Arrival& arrival = *arrivals[k];
    for (TimedMove& move : timed_moves(times_, {stops[k - 1].position, stops[k].position}, arrival.departure,
                                       arrival.t, stops[k].reverse)) {
      trajectory.moves.push_back(move);
    }
    served(stops[k - 1], stops[k], arrival.t, &trajectory.visits);
  }
  trajectory.visits.pop_back();  // the last goal
  trajectory.cost = std::max(arrivals.back()->ready, arrivals.back()->t);
  return trajectory;
}

}  // namespace fleetplan::core
