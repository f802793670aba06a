#include "core/prioritized/partial_plan.h"

#include <algorithm>
#include <utility>

#include "core/prioritized/blocking_robots.h"

namespace fleetplan::core {
namespace {

using Reason = Unplanned::Reason;

class PartialPlanner {
 public:
  PartialPlanner(PlanState& state, const StopCondition& stop, ProgressReport& progress)
      : state_(state),
        stop_(stop),
        progress_(progress),
        blocking_(state, stop),
        has_no_path_(state.instance().size(), false) {}

  PartialPlan run(const std::vector<std::size_t>& unsolved, const std::vector<std::size_t>& given_up) {
    staying_ = given_up;
    for (const std::size_t robot : unsolved) {
      if (!state_.trajectory(robot)) stay(robot);
    }
    stop_conflicting_robots();
    progress_.update();
    while (plan_staying_robots()) {
    }
    std::sort(staying_.begin(), staying_.end());
    for (const std::size_t robot : staying_) result_.unplanned.push_back(explain(robot));
    return std::move(result_);
  }

 private:
  void stay(std::size_t robot) {
    state_.stay_at_start(robot);
    staying_.push_back(robot);
  }

  void stop_conflicting_robots() {
    for (std::size_t k = 0; k < staying_.size(); ++k) {  // staying_ grows
      for (const std::size_t crossing : state_.robots_crossing_start(staying_[k])) {
        if (state_.trajectory(crossing)) stay(crossing);
      }
    }
  }

  /// Tries each robot that stays once; returns whether another round may help.
  bool plan_staying_robots() {
    std::vector<std::size_t> still_staying;
    for (const std::size_t robot : staying_) {
      if (!try_plan(robot)) still_staying.push_back(robot);
    }
    const bool progress = still_staying.size() < staying_.size() && !still_staying.empty();
    staying_ = std::move(still_staying);
    return progress && !result_.cut_off;
  }

  bool try_plan(std::size_t robot) {
    if (stop_.met()) {
      result_.cut_off = true;
      return false;
    }
    state_.remove(robot);
    SearchResult result = state_.plan(robot, {}, stop_);
    if (result.trajectory) {
      state_.follow(robot, std::move(*result.trajectory));
      progress_.update();
      return true;
    }
    state_.stay_at_start(robot);
    has_no_path_[robot] = result.complete;
    result_.cut_off = result_.cut_off || !result.complete;
    return false;
  }

  Unplanned explain(std::size_t robot) {
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
  std::vector<bool> has_no_path_;  // by robot; according to its last search
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
