#include "core/prioritized/partial_plan.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "core/prioritized/blocking_robots.h"
#include "core/prioritized/without_way.h"

namespace fleetplan::core {
namespace {

using Reason = Unplanned::Reason;

/// The expansions of a search, round by round: most robots that have a path find it soon, and a search that
/// fails may take as long as hundreds that do not.
constexpr auto kAnyNumber = std::numeric_limits<std::int64_t>::max();
constexpr std::array<std::int64_t, 3> kExpansions{500, 5'000, kAnyNumber};

class PartialPlanner {
 public:
  PartialPlanner(PlanState& state, const StopCondition& stop, ProgressReport& progress)
      : state_(state),
        stop_(stop),
        progress_(progress),
        blocking_(state, stop),
        has_no_path_(state.instance().size(), false),
        earlier_(state.instance().size()),
        waiting_for_(state.instance().size()) {}

  PartialPlan run(const std::vector<std::size_t>& unsolved, const std::vector<std::size_t>& given_up) {
    staying_ = given_up;
    for (const std::size_t robot : unsolved) {
      if (!state_.trajectory(robot)) stay(robot);
    }
    stop_conflicting_robots();
    progress_.update();
    for (std::size_t effort = 0; effort < kExpansions.size();) {
      if (!plan_staying_robots(kExpansions[effort])) ++effort;
    }
    std::sort(staying_.begin(), staying_.end());
    for (const std::size_t robot : staying_) result_.unplanned.push_back(explain(robot));
    return std::move(result_);
  }

 private:
  void stay(std::size_t robot) {
    earlier_[robot] = state_.trajectory(robot);
    state_.stay_at_start(robot);
    staying_.push_back(robot);
  }

  void stop_conflicting_robots() {
    for (std::size_t k = 0; k < staying_.size(); ++k) {  // staying_ grows
      for (const std::size_t crossing : state_.robots_crossing_start(staying_[k])) {
        if (state_.trajectory(crossing)) stay(crossing);
        if (earlier_[crossing]) waiting_for_[staying_[k]].push_back(crossing);
      }
    }
  }

  /// Tries each robot that stays once; returns whether another round may help.
  bool plan_staying_robots(std::int64_t max_expansions) {
    const std::vector<std::size_t> robots = staying_;
    for (const std::size_t robot : robots) {
      if (!state_.trajectory(robot) && try_plan(robot, max_expansions)) resume_those_waiting_for(robot);
    }
    std::erase_if(staying_, [&](std::size_t robot) { return state_.trajectory(robot).has_value(); });
    return staying_.size() < robots.size() && !staying_.empty() && !stop_.met();
  }

  /// Robots that crossed the start of a robot that has left it may follow their earlier trajectories again.
  void resume_those_waiting_for(std::size_t robot) {
    std::vector<std::size_t> left{robot};
    while (!left.empty()) {
      const std::vector<std::size_t> waiting = std::move(waiting_for_[left.back()]);
      left.pop_back();
      for (const std::size_t other : waiting) {
        if (state_.trajectory(other)) continue;
        state_.remove(other);
        if (state_.conflicting_robots(other, *earlier_[other]).empty()) {
          state_.follow(other, *earlier_[other]);
          left.push_back(other);
        } else {
          state_.stay_at_start(other);
        }
      }
    }
    progress_.update();
  }

  bool try_plan(std::size_t robot, std::int64_t max_expansions) {
    if (stop_.met()) {
      result_.cut_off = true;
      return false;
    }
    state_.remove(robot);
    const SearchLimits limits{.thorough = max_expansions == kAnyNumber, .max_expansions = max_expansions};
    SearchResult result = state_.plan(robot, limits, stop_);
    if (result.trajectory) {
      state_.follow(robot, std::move(*result.trajectory));
      return true;
    }
    state_.stay_at_start(robot);
    has_no_path_[robot] = result.complete;
    result_.cut_off = result_.cut_off || (!result.complete && stop_.met());
    return false;
  }

  Unplanned explain(std::size_t robot) {
    if (state_.way_to_goal(robot).none()) return unplanned_without_way(robot, state_.way_to_goal(robot));
    if (!has_no_path_[robot]) {
      return {robot, Reason::budget_exhausted, "The time budget ended before a way was found.", {}};
    }
    Unplanned unplanned{robot, Reason::blocked_by_robots,
                        "No way was found that keeps clear of the other robots.", blocking_.find(robot)};
    result_.cut_off = result_.cut_off || stop_.met();
    return unplanned;
  }

  PlanState& state_;
  const StopCondition& stop_;
  ProgressReport& progress_;
  BlockingRobots blocking_;
  std::vector<bool> has_no_path_;                      // by robot; according to its last search
  std::vector<std::optional<Trajectory>> earlier_;     // of robots that were stopped
  std::vector<std::vector<std::size_t>> waiting_for_;  // by robot: those stopped as they cross its start
  std::vector<std::size_t> staying_;
  PartialPlan result_;
};

}  // namespace

PartialPlan make_partial_plan(PlanState& state, const std::vector<std::size_t>& unsolved,
                              const std::vector<std::size_t>& given_up, const StopCondition& stop,
                              ProgressReport& progress) {
  return PartialPlanner(state, stop, progress).run(unsolved, given_up);
}

}  // namespace fleetplan::core
