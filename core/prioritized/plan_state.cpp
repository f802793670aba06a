#include "core/prioritized/plan_state.h"

#include <algorithm>
#include <limits>
#include <new>
#include <utility>

#include "core/runtime/memory_account.h"
#include "core/sipp/goals.h"

namespace fleetplan::core {
namespace {

/// Steps of Enclosure for each expansion of a search on the map, which takes five times as long.
constexpr std::int64_t kEnclosureSteps = 2;
/// Steps of Enclosure for a way that the lattice misses: about 2 ms.
constexpr std::int64_t kOffLatticeSteps = 50'000;
/// A lattice has every way that is wider than the robot by this many spacings.
constexpr double kWidestCells = 3.0;
/// Expansions of a search on the map before Enclosure is asked.
constexpr std::int64_t kFirstExpansions = 16'384;
/// Seconds: a way that ends later by less is no later than by the previous plan; far above rounding.
constexpr double kNoLater = 1e-6;
/// Seconds: later than any robot leaves the place where it was served.
constexpr double kAfterAllExits = 1e6;
/// Goals of a robot between two checks of the stop condition.
constexpr std::size_t kGoalsBetweenStops = 16;

std::vector<LargestDisk> largest_disks(const Instance& instance) {
  std::vector<LargestDisk> disks;
  disks.reserve(instance.size());
  for (std::size_t i = 0; i < instance.size(); ++i) disks.push_back(instance.largest_disk(i));
  return disks;
}

/// The part of contiguous segments from `t` on.
std::vector<SizedSegment> from_time(double t, std::vector<SizedSegment> segments) {
  std::erase_if(segments, [&](const SizedSegment& segment) { return segment.t_end <= t; });
  if (!segments.empty() && segments.front().t_start < t) {
    SizedSegment& first = segments.front();
    if (first.ramp == 0.0) {
      first.path.from += first.velocity() * (t - first.t_start);
      first.t_start = t;
    } else {
      static_cast<TimedSegment&>(first) = first.from_time(t);
    }
  }
  return segments;
}

/// The part of contiguous segments until `t`.
std::vector<SizedSegment> until_time(double t, std::vector<SizedSegment> segments) {
  std::erase_if(segments, [&](const SizedSegment& segment) { return segment.t_start >= t; });
  if (!segments.empty() && segments.back().t_end > t) {
    SizedSegment& last = segments.back();
    if (last.ramp == 0.0) {
      last.path.to = last.path.from + last.velocity() * (t - last.t_start);
      last.t_end = t;
    } else {
      static_cast<TimedSegment&>(last) = last.until_time(t);
    }
  }
  return segments;
}

const Contacts* contacts(const Instance& instance) {
  return instance.contacts().empty() ? nullptr : &instance.contacts();
}

const FixedReservations* fixed_reservations(const Instance& instance) {
  const FixedReservations& fixed = *instance.fixed_reservations();
  return fixed.empty() ? nullptr : &fixed;
}

}  // namespace

PlanState::PlanState(const Instance& instance)
    : instance_(instance),
      table_(instance.problem().grid().width(), instance.problem().grid().height(),
             instance.problem().grid().resolution(), largest_disks(instance), contacts(instance),
             fixed_reservations(instance), instance.options().interval_margin),
      search_(table_),
      reservations_{std::vector<std::optional<Trajectory>>(instance.size()),
                    std::vector<double>(instance.size(), 0.0)},
      search_spaces_(instance),
      ways_(instance.size()) {
  for (std::size_t robot = 0; robot < instance.size(); ++robot) {
    if (instance.robot(robot).yields() && !instance.robot(robot).invalid) yielding_.push_back(robot);
  }
}

Trajectory PlanState::staying(std::size_t robot) const { return instance_.itinerary(robot).committed; }

std::vector<SizedSegment> PlanState::after_commitment(std::size_t robot, const Trajectory& trajectory) const {
  const double t_begin = instance_.itinerary(robot).t_begin;
  std::vector<SizedSegment> segments = instance_.segments(robot, trajectory);
  return t_begin > 0.0 ? from_time(t_begin, std::move(segments)) : segments;
}

void PlanState::reserve(std::size_t robot, const std::vector<SizedSegment>& segments) {
  remove(robot);
  table_.reserve(robot, segments);
}

void PlanState::remove(std::size_t robot) {
  table_.remove(robot);
  if (trajectory(robot)) --planned_count_;
  reservations_.trajectories[robot].reset();
  if (stays(robot)) {
    --staying_count_;
    forget_ways_closed_by_robots(robot);
  }
  reservations_.holds_place_for[robot] = 0.0;
}

void PlanState::forget_ways_closed_by_robots(std::size_t except) {
  const auto forget = [&](std::size_t robot) { return robot != except; };
  for (const std::size_t robot : closed_by_robots_) {
    if (forget(robot)) ways_[robot] = {};
  }
  std::erase_if(closed_by_robots_, forget);
}

void PlanState::follow(std::size_t robot, Trajectory trajectory) {
  reserve(robot, after_commitment(robot, trajectory));
  reservations_.trajectories[robot] = std::move(trajectory);
  ++planned_count_;
}

void PlanState::stay_in_place(std::size_t robot) { reserve_place(robot, kForever); }

void PlanState::reserve_place(std::size_t robot, double seconds) {
  const Itinerary& itinerary = instance_.itinerary(robot);
  const Position& place = itinerary.pose.position;
  remove(robot);
  if (seconds > 0.0) {
    const TimedSegment rest{{place, place}, itinerary.t_begin, itinerary.t_begin + seconds};
    table_.reserve(robot, {{rest, instance_.radius(robot, 0)}});
  }
  reservations_.holds_place_for[robot] = seconds;
  if (seconds == kForever) ++staying_count_;
}

/// Whether the robot's reservation is the one that it has among these.
bool PlanState::is_reserved(std::size_t robot, const Reservations& among) const {
  const auto& now = trajectory(robot);
  const auto& other = among.trajectories[robot];
  if (now.has_value() != other.has_value()) return false;
  if (!now) return reservations_.holds_place_for[robot] == among.holds_place_for[robot];
  const auto same_visit = [](const Visit& a, const Visit& b) {
    return a.goal == b.goal && a.t_arrive == b.t_arrive && a.t_leave == b.t_leave;
  };
  return now->cost == other->cost && now->is_previous == other->is_previous &&
         std::equal(now->visits.begin(), now->visits.end(), other->visits.begin(), other->visits.end(),
                    same_visit) &&
         std::equal(now->moves.begin(), now->moves.end(), other->moves.begin(), other->moves.end(),
                    [](const TimedSegment& a, const TimedSegment& b) {
                      return a.t_start == b.t_start && a.t_end == b.t_end && a.path.to == b.path.to;
                    });
}

void PlanState::restore(const Reservations& reservations) {
  const Reservations wanted = reservations;                           // may be those of this state
  if (!is_in_table_) forget_ways_closed_by_robots(instance_.size());  // by all: others may stay now
  for (std::size_t robot = 0; robot < instance_.size(); ++robot) {
    if (is_in_table_ && is_reserved(robot, wanted)) continue;
    if (wanted.trajectories[robot]) {
      follow(robot, *wanted.trajectories[robot]);
    } else {
      reserve_place(robot, wanted.holds_place_for[robot]);
    }
  }
  is_in_table_ = true;
}

void PlanState::set_without_table(const Reservations& reservations) {
  reservations_ = reservations;
  is_in_table_ = false;
  planned_count_ = 0;
  staying_count_ = 0;
  for (std::size_t robot = 0; robot < instance_.size(); ++robot) {
    if (trajectory(robot)) ++planned_count_;
    if (stays(robot)) ++staying_count_;
  }
}

void PlanState::resume() {
  if (!is_in_table_) restore(reservations_);
}

template <class Result, class Compute>
Result PlanState::within_memory(Result otherwise, const Compute& compute) {
  bool is_spent = false;
  try {
    otherwise = compute();
  } catch (const std::bad_alloc&) {
    is_spent = true;
  }
  if (is_spent || is_short_of_memory()) release_memory();
  return otherwise;
}

void PlanState::release_memory() {
  search_.release_memory();
  search_spaces_.discard_all();
}

void PlanState::relieve_memory() {
  if (is_short_of_memory()) release_memory();
}

/// Ends a search when robots that stay are found to close off the robot.
class PlanState::EnclosureTest final : public NoPathTest {
 public:
  EnclosureTest(PlanState& state, std::size_t robot) : state_(state), robot_(robot) {}
  bool no_path(std::int64_t expansions) override {
    return state_.test_enclosure(robot_, kEnclosureSteps * expansions);
  }

 private:
  PlanState& state_;
  std::size_t robot_;
};

SearchResult PlanState::plan(std::size_t robot, const SearchLimits& limits, const StopCondition& stop) {
  // With a horizon, a robot that is closed off may come nearer to its goal all the same.
  if (staying_count_ == 0 || instance_.options().horizon) return search(robot, limits, stop);
  EnclosureTest test(*this, robot);
  SearchLimits with_test = limits;
  with_test.no_path_test = &test;
  return search(robot, with_test, stop);
}

SearchResult PlanState::search(std::size_t robot, const SearchLimits& limits, const StopCondition& stop) {
  if (robot == whole_way_of_) {
    SearchResult whole = search_whole_way(robot, limits, stop);
    if (whole.trajectory) return whole;
    whole_way_of_.reset();
  }
  return search_until(instance_.options().horizon.value_or(kForever), robot, limits, stop);
}

/// Robots with nothing to do may make way for others, but may also be unable to: whoever waits before one
/// would wait for ever, although there is another way.
SearchResult PlanState::search_whole_way(std::size_t robot, const SearchLimits& limits,
                                         const StopCondition& stop) {
  const std::vector<std::size_t> arrived = arrived_without_plan(robot);
  const std::vector<double> reserved = reservations_.holds_place_for;
  for (const std::size_t other : arrived) stay_in_place(other);
  EnclosureTest test(*this, robot);
  SearchLimits with_test = limits;
  with_test.no_path_test = &test;
  with_test.bound = std::min(limits.bound, previous_service_end(instance_.robot(robot)) + kNoLater);
  SearchResult result = search_until(kForever, robot, with_test, stop);
  if (!result.trajectory && with_test.bound < limits.bound) {
    with_test.bound = limits.bound;
    result = search_until(kForever, robot, with_test, stop);
  }
  for (const std::size_t other : arrived) reserve_place(other, reserved[other]);
  if (std::erase(closed_by_robots_, robot) > 0) ways_[robot] = {};  // by robots that may make way
  return result;
}

/// The robots, but for one, that stand at their goals and have no plan yet.
std::vector<std::size_t> PlanState::arrived_without_plan(std::size_t except) const {
  std::vector<std::size_t> arrived;
  for (std::size_t other = 0; other < instance_.size(); ++other) {
    const Robot& robot = instance_.robot(other);
    if (other == except || !robot.goal || trajectory(other) || stays(other)) continue;
    if (has_arrived(robot)) arrived.push_back(other);
  }
  return arrived;
}

SearchResult PlanState::search_until(double horizon, std::size_t robot, const SearchLimits& limits,
                                     const StopCondition& stop) {
  if (horizon == kForever && !goal_stays_free(robot)) return {};
  constexpr auto no_memory = [] { return SearchResult{std::nullopt, false, 0}; };
  const auto search_once = [&]() -> SearchResult {
    constexpr auto kAnyNumber = std::numeric_limits<std::int64_t>::max();
    const Way& way = way_to_goal(robot, kAnyNumber, stop);
    if (way.kind == Way::Kind::unknown) return no_memory();
    if (way.none()) return {};
    SearchSpace* space = search_spaces_.of(robot, stop);
    if (space == nullptr) return no_memory();
    SearchLimits within = limits;
    within.bound = std::min(limits.bound, instance_.longest_plan(robot));
    within.horizon = horizon;
    return search_.run(*space, within, stop);
  };
  const std::int64_t shortages = memory_shortages();
  SearchResult result = within_memory(no_memory(), search_once);
  // What was kept of other searches is discarded by now, which may leave enough for this one.
  const bool lacked_memory = !result.trajectory && !result.complete && memory_shortages() > shortages;
  if (lacked_memory && !stop.met()) result = within_memory(no_memory(), search_once);
  expansions_ += result.expansions;
  return result;
}

/// Whether the robot may rest at its goal from some time on: if not, a search need not be prepared.
bool PlanState::goal_stays_free(std::size_t robot) const {
  if (instance_.robot(robot).yields()) return true;
  const std::size_t at_rest = instance_.itinerary(robot).goals.size();
  const Footprint footprint{robot, instance_.radius(robot, at_rest)};
  const auto safe = table_.safe_intervals(footprint, instance_.robot(robot).goal->position);
  return !safe.empty() && safe.back().end == kForever;
}

SearchResult PlanState::plan_past_yielding(std::size_t robot, const SearchLimits& limits,
                                           const StopCondition& stop) {
  std::vector<std::size_t> shortened;
  for (const std::size_t other : yielding_) {
    const auto rests_from = other != robot && trajectory(other) ? done_from(other) : std::nullopt;
    if (!rests_from) continue;
    std::vector<SizedSegment> segments = until_time(*rests_from + instance_.options().start_safe_interval,
                                                    after_commitment(other, *trajectory(other)));
    table_.remove(other);
    if (!segments.empty()) table_.reserve(other, segments);
    shortened.push_back(other);
  }
  if (shortened.empty()) return {};
  SearchResult result = search(robot, limits, stop);
  for (const std::size_t other : shortened) {
    table_.remove(other);
    table_.reserve(other, after_commitment(other, *trajectory(other)));
  }
  return result;
}

SearchResult PlanState::plan_leaving_for(std::size_t other, std::size_t robot, const SearchLimits& limits,
                                         const StopCondition& stop) {
  const Trajectory followed = *trajectory(robot);
  const Itinerary& itinerary = instance_.itinerary(other);
  const auto distance = [&](const Goal& goal) { return (goal.position - followed.end()).squaredNorm(); };
  std::size_t nearest = 0;
  for (std::size_t k = 1; k < itinerary.goals.size(); ++k) {
    if (distance(itinerary.goals[k]) < distance(itinerary.goals[nearest])) nearest = k;
  }
  const Position& place = itinerary.goals[nearest].position;
  remove(robot);
  table_.reserve(other, {{{{place, place}, kAfterAllExits, kForever}, instance_.radius(other, nearest)}});
  SearchResult result = search(robot, limits, stop);
  table_.remove(other);
  follow(robot, followed);
  return result;
}

bool PlanState::makes_way(std::size_t robot) const {
  if (!instance_.robot(robot).yields() || !trajectory(robot)) return false;
  const std::vector<TimedSegment>& moves = trajectory(robot)->moves;
  const auto done = done_from(robot);
  return done && !moves.empty() && moves.back().t_start >= *done;
}

/// From when on a robot that yields has served its own goals by its trajectory; none if it does not.
std::optional<double> PlanState::done_from(std::size_t robot) const {
  const std::size_t own_goals = instance_.robot(robot).own_goal_count();
  const Itinerary& itinerary = instance_.itinerary(robot);
  if (itinerary.first_goal >= own_goals) return itinerary.t_begin;
  const std::vector<Visit>& visits = trajectory(robot)->visits;
  if (visits.empty() || visits.back().goal + 1 < own_goals) return std::nullopt;
  return visits.back().t_leave;
}

SearchResult PlanState::plan_ignoring(const std::vector<std::size_t>& ignored, std::size_t robot,
                                      const SearchLimits& limits, const StopCondition& stop) {
  const bool all_move =
      std::none_of(ignored.begin(), ignored.end(), [&](std::size_t other) { return stays(other); });
  for (const std::size_t other : ignored) table_.ignore(other, true);
  SearchResult result = all_move ? plan(robot, limits, stop) : search(robot, limits, stop);
  for (const std::size_t other : ignored) table_.ignore(other, false);
  return result;
}

bool PlanState::can_leave_place(std::size_t robot, const StopCondition& stop) {
  return within_memory(true, [&] {
    SearchSpace* space = search_spaces_.of(robot, stop);
    if (space == nullptr) return true;
    const Vertices& vertices = space->vertices();
    bool can_leave = false;
    vertices.for_each_neighbour(vertices.start(), [&](int) { can_leave = true; });
    return can_leave;
  });
}

const Way& PlanState::way_to_goal(std::size_t robot, std::int64_t max_expansions, const StopCondition& stop) {
  Way& way = ways_[robot];
  if (way.kind != Way::Kind::unknown) return way;
  within_memory(false, [&] {
    find_way(robot, max_expansions, stop);
    return true;
  });
  return way;
}

void PlanState::find_way(std::size_t robot, std::int64_t max_expansions, const StopCondition& stop) {
  SearchSpace* space = search_spaces_.of(robot, stop);
  if (space == nullptr) return;
  std::int64_t left = max_expansions;
  for (std::size_t goal = 0; goal < space->goal_count(); ++goal) {
    ways_[robot] = {};
    if (goal % kGoalsBetweenStops == kGoalsBetweenStops - 1 && stop.met()) break;
    left -= find_leg(robot, *space, goal, left, stop);
    if (ways_[robot].kind != Way::Kind::on_lattice) break;
  }
  map_expansions_ += max_expansions - left;
}

/// The way to a goal from the one before, or from where the plan begins. Returns the expansions.
std::int64_t PlanState::find_leg(std::size_t robot, SearchSpace& space, std::size_t goal,
                                 std::int64_t max_expansions, const StopCondition& stop) {
  Way& way = ways_[robot];
  const int from = space.begin_of(goal);
  if (from == space.goal(goal).vertex) {
    way.kind = Way::Kind::on_lattice;
    return 0;
  }
  CostToGo& costs = space.cost_to_go(goal);
  const std::int64_t before = costs.expansions();
  std::int64_t last = 0;
  for (std::int64_t next = kFirstExpansions; way.kind == Way::Kind::unknown && last < max_expansions;) {
    const std::int64_t count = std::min(next, max_expansions) - last;
    const auto reaches = costs.reaches(from, count, stop);
    last += count;
    next *= 2;
    if (reaches && *reaches) way.kind = Way::Kind::on_lattice;
    if (reaches && !*reaches) {
      way = space.goal_count() == 1 ? way_off_lattice(robot) : Way{Way::Kind::not_on_lattice, {}, {}};
    }
    if (reaches || stop.met()) break;
    test_enclosure(robot, kEnclosureSteps * last);
  }
  return costs.expansions() - before;
}

/// For a robot without a way on the lattice: whether obstacles close off its goal on any lattice.
Way PlanState::way_off_lattice(std::size_t robot) const {
  Enclosure enclosure(instance_, robot, {});
  if (enclosure.find(kOffLatticeSteps).answer == Enclosure::Answer::closed)
    return {Way::Kind::closed, {}, {}};
  const double limit =
      2.0 * instance_.motion(robot).radius + kWidestCells * instance_.lattice(robot).spacing();
  return {Way::Kind::not_on_lattice, {}, enclosure.widest_way(limit, kOffLatticeSteps)};
}

bool PlanState::test_enclosure(std::size_t robot, std::int64_t max_steps) {
  std::vector<std::size_t> staying;
  for (std::size_t other = 0; other < instance_.size(); ++other) {
    if (stays(other) && other != robot) staying.push_back(other);
  }
  Enclosure::Result result = Enclosure(instance_, robot, staying).find(max_steps);
  if (result.answer != Enclosure::Answer::closed) return false;
  if (!result.robots.empty()) closed_by_robots_.push_back(robot);
  ways_[robot] = {Way::Kind::closed, std::move(result.robots), {}};
  return true;
}

bool PlanState::takes_too_long(std::size_t robot, const StopCondition& stop) {
  return within_memory(false, [&] {
    SearchSpace* space = search_spaces_.of(robot, stop);
    return space != nullptr && estimated_end(*space, stop) >= instance_.longest_plan(robot);
  });
}

double PlanState::estimated_alone(std::size_t robot, const StopCondition& stop) {
  return within_memory(kForever, [&] {
    SearchSpace* space = search_spaces_.of(robot, stop);
    const double end = space != nullptr ? estimated_end(*space, stop) : 0.0;
    return end > 0.0 ? end : kForever;
  });
}

Trajectory PlanState::plan_alone(std::size_t robot, const StopCondition& stop) {
  const OccupancyGrid& grid = instance_.problem().grid();
  const double cell_size = grid.width();  // coarse, as the table stays empty
  const ReservationTable empty(grid.width(), grid.height(), cell_size, largest_disks(instance_));
  SearchResult result = within_memory(SearchResult(), [&]() -> SearchResult {
    SearchSpace* space = search_spaces_.of(robot, stop);
    if (space == nullptr) return {};
    AaSipp search(empty);
    return search.run(*space, {.horizon = instance_.options().horizon.value_or(kForever)}, stop);
  });
  return result.trajectory ? std::move(*result.trajectory) : staying(robot);
}

std::vector<std::size_t> PlanState::conflicting_robots(std::size_t robot,
                                                       const Trajectory& trajectory) const {
  return table_.robots_hit(robot, after_commitment(robot, trajectory));
}

std::vector<std::size_t> PlanState::robots_committed_against(std::size_t robot,
                                                             const Trajectory& trajectory) const {
  return table_.robots_certainly_hit(robot, after_commitment(robot, trajectory));
}

std::vector<std::size_t> PlanState::robots_crossing_place(std::size_t robot) const {
  return conflicting_robots(robot, staying(robot));
}

}  // namespace fleetplan::core
