#include "core/moves/safe_plan.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "core/explain/blocking_robots.h"
#include "core/explain/triage.h"

namespace fleetplan::core {
namespace {

using Reason = Unplanned::Reason;

/// The share of the time for planning robots around others. The rest of the robots stay if this time is not
/// expected to suffice, or if more than one robot in kLeadsPerFailure finds no way.
constexpr double kShareOfLeading = 0.6;
constexpr std::size_t kLeadsPerFailure = 5;
/// Searches before this is judged, and the expected searches for each robot.
constexpr std::size_t kFirstLeads = 10;
constexpr double kLeadsPerRobot = 1.3;

/// The searches for one robot, round by round: most robots that have a path find it soon, and a search that
/// fails may take as long as hundreds that do not. A long way adds expansions, so many for each step on the
/// lattice.
constexpr std::array<SearchSettings, 3> kRounds{{
    {.heuristic_weight = 2.0, .thorough = false, .max_expansions = 200},
    {.thorough = false, .max_expansions = 5'000},
    {},
}};
constexpr std::array<double, 2> kExpansionsPerStep{4.0, 20.0};

std::size_t rounds_of(Effort effort) {
  if (effort == Effort::none) return 0;
  return effort == Effort::full ? kRounds.size() : kRounds.size() - 1;
}

class SafePlanner {
  using Clock = StopCondition::Clock;

 public:
  SafePlanner(PlanState& state, Effort effort, const StopCondition& stop, ProgressReport& progress)
      : state_(state),
        reservations_(state.reservations()),
        rounds_(rounds_of(effort)),
        stop_(stop),
        progress_(progress),
        has_no_path_(state.instance().size(), false),
        earlier_(state.instance().size()),
        waiting_for_(state.instance().size()) {}

  SafePlan run(const std::vector<std::size_t>& unsolved, const std::vector<std::size_t>& given_up) {
    staying_ = given_up;
    for (const std::size_t robot : unsolved) {
      if (!reservations_.trajectory(robot)) stay(robot);
    }
    clear_places();
    sort_by_distance();
    progress_.update();
    for (std::size_t round = 0; round < rounds_;) {
      if (!plan_staying_robots(round)) ++round;
    }
    std::sort(staying_.begin(), staying_.end());
    for (const std::size_t robot : staying_) result_.staying.push_back({robot, has_no_path_[robot]});
    return std::move(result_);
  }

 private:
  void stay(std::size_t robot) {
    earlier_[robot] = reservations_.trajectory(robot);
    reservations_.stay_in_place(robot);
    staying_.push_back(robot);
  }

  /// Leads robots that cross the place of one that stays around it. Those that find no way there stay as
  /// well.
  void clear_places() {
    const Clock::time_point begin = Clock::now();
    const std::size_t total = rounds_ > 0 ? count_crossing() : 0;
    std::size_t led = 0;
    std::size_t failed = 0;
    bool leads = rounds_ > 0;
    bool in_time = true;
    // Bounded: each robot begins to stay once, and one that crosses its place is led or stays.
    for (std::size_t k = 0; k < staying_.size(); ++k) {  // staying_ grows
      for (const std::size_t crossing : reservations_.robots_crossing_place(staying_[k])) {
        in_time = in_time && !stop_.met() && may_lead_all(begin, led, total);
        if (leads && in_time && reservations_.trajectory(crossing)) {
          ++led;
          if (lead(crossing)) continue;
          leads = ++failed * kLeadsPerFailure < led + kFirstLeads;
        }
        if (reservations_.trajectory(crossing)) stay(crossing);
        if (earlier_[crossing]) waiting_for_[staying_[k]].push_back(crossing);
      }
    }
    result_.cut_off = result_.cut_off || (leads && !in_time);
  }

  std::size_t count_crossing() const {
    std::vector<bool> crosses(state_.instance().size(), false);
    // Bounded: pairs of robots that meet.
    for (const std::size_t robot : staying_) {
      for (const std::size_t other : reservations_.robots_crossing_place(robot)) {
        crosses[other] = crosses[other] || reservations_.trajectory(other);
      }
    }
    return static_cast<std::size_t>(std::count(crosses.begin(), crosses.end(), true));
  }

  /// Whether so many robots are likely to be led in time if `led` have been since `begin`.
  bool may_lead_all(Clock::time_point begin, std::size_t led, std::size_t total) const {
    if (led < kFirstLeads || stop_.deadline() == Clock::time_point::max()) return true;
    const Clock::duration so_long = Clock::now() - begin;
    const double times_as_long =
        std::max(1.0, kLeadsPerRobot * static_cast<double>(total) / static_cast<double>(led));
    return so_long * times_as_long < (stop_.deadline() - begin) * kShareOfLeading;
  }

  bool lead(std::size_t robot) {
    state_.memory().relieve();
    return state_.replan(robot, search_for(robot, 0), stop_).trajectory.has_value();
  }

  /// Returns the settings for a robot in a round.
  SearchSettings search_for(std::size_t robot, std::size_t round) {
    SearchSettings settings = kRounds[round];
    if (round + 1 == kRounds.size()) return settings;
    const double seconds = state_.ways().estimated_alone(robot, stop_);
    if (seconds == kForever) return settings;
    const double steps =
        seconds * state_.instance().body(robot).linear_speed / state_.instance().lattice(robot).spacing();
    settings.max_expansions += static_cast<std::int64_t>(kExpansionsPerStep[round] * steps);
    return settings;
  }

  /// Sorts the robots that stay by the length of their way, shortest first: they seldom cross the starts of
  /// others.
  void sort_by_distance() {
    const auto distance = [&](std::size_t robot) {
      const Itinerary& itinerary = state_.instance().itinerary(robot);
      return (itinerary.last_goal().position - itinerary.pose.position).norm();
    };
    std::stable_sort(staying_.begin(), staying_.end(),
                     [&](std::size_t a, std::size_t b) { return distance(a) < distance(b); });
  }

  /// Plans each robot that stays once. Returns whether another round may help.
  bool plan_staying_robots(std::size_t round) {
    const std::vector<std::size_t> robots = staying_;
    for (const std::size_t robot : robots) {
      if (!reservations_.trajectory(robot) && try_plan(robot, search_for(robot, round)))
        resume_those_waiting_for(robot);
    }
    std::erase_if(staying_, [&](std::size_t robot) { return reservations_.trajectory(robot).has_value(); });
    return staying_.size() < robots.size() && !staying_.empty() && !stop_.met();
  }

  /// Lets robots that crossed the start of `robot`, which has left it, follow their earlier trajectories
  /// again.
  void resume_those_waiting_for(std::size_t robot) {
    std::vector<std::size_t> left{robot};
    // Bounded: a robot waits for one other, and goes on once.
    while (!left.empty()) {
      const std::vector<std::size_t> waiting = std::move(waiting_for_[left.back()]);
      left.pop_back();
      for (const std::size_t other : waiting) {
        if (reservations_.trajectory(other)) continue;
        reservations_.remove(other);
        if (reservations_.conflicting_robots(other, *earlier_[other]).empty()) {
          reservations_.follow(other, *earlier_[other]);
          left.push_back(other);
        } else {
          reservations_.stay_in_place(other);
        }
      }
    }
    progress_.update();
  }

  bool try_plan(std::size_t robot, const SearchSettings& settings) {
    state_.memory().relieve();
    if (stop_.met()) {
      result_.cut_off = true;
      return false;
    }
    reservations_.remove(robot);
    SearchResult result = state_.plan(robot, settings, stop_);
    if (result.trajectory) {
      reservations_.follow(robot, std::move(*result.trajectory));
      return true;
    }
    reservations_.stay_in_place(robot);
    has_no_path_[robot] = result.complete;
    result_.cut_off = result_.cut_off || (!result.complete && stop_.met());
    return false;
  }

  PlanState& state_;
  FleetReservations& reservations_;
  const std::size_t rounds_;
  const StopCondition& stop_;
  ProgressReport& progress_;
  std::vector<bool> has_no_path_;                      // by robot, according to its last search
  std::vector<std::optional<Trajectory>> earlier_;     // trajectories of robots that were stopped
  std::vector<std::vector<std::size_t>> waiting_for_;  // by robot: the robots stopped for crossing its start
  std::vector<std::size_t> staying_;
  SafePlan result_;
};

Unplanned explain(PlanState& state, const SafePlan::Staying& staying, BlockingRobots& blocking) {
  const std::size_t robot = staying.robot;
  const Way& way = state.ways().way_to_goal(robot);
  if (way.none()) return unplanned_without_way(robot, state.instance().body(robot).wall_radius, way);
  if (!staying.has_no_path) {
    return {robot, Reason::budget_exhausted, "The time budget ended before a way was found.", {}};
  }
  return {robot, Reason::blocked_by_robots, "No way was found that keeps clear of the other robots.",
          blocking.find(robot)};
}

}  // namespace

SafePlan make_safe(PlanState& state, const std::vector<std::size_t>& unsolved,
                   const std::vector<std::size_t>& given_up, Effort effort, const StopCondition& stop,
                   ProgressReport& progress) {
  return SafePlanner(state, effort, stop, progress).run(unsolved, given_up);
}

bool return_to(FleetReservations& reservations, const PlanSnapshot& snapshot, const StopCondition& stop) {
  const bool is_over = stop.is_over();
  if (is_over) {
    reservations.set_without_table(snapshot.reservations);
  } else {
    reservations.restore(snapshot.reservations);
  }
  return !is_over;
}

PartialPlan explain(PlanState& state, const SafePlan& plan, const StopCondition& stop) {
  BlockingRobots blocking(state, stop);
  PartialPlan partial;
  for (const SafePlan::Staying& staying : plan.staying) {
    if (state.instance().itinerary(staying.robot).is_idle) continue;  // it need not move
    partial.unplanned.push_back(explain(state, staying, blocking));
  }
  partial.cut_off = plan.cut_off || (!plan.staying.empty() && stop.met());
  return partial;
}

}  // namespace fleetplan::core
