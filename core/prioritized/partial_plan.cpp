#include "core/prioritized/partial_plan.h"

#include <algorithm>
#include <utility>

namespace fleetplan::core {
namespace {

using Reason = Unplanned::Reason;

/// To find out who is in the way of the unplanned robots, all together: about a tenth of a second.
constexpr std::int64_t kMostReductionExpansions = 20'000;

class Completing {
 public:
  Completing(PlanState& state, const StopCondition& stop, ProgressReport& progress)
      : state_(state), stop_(stop), progress_(progress), no_way_(state.instance().size(), false) {}

  PartialPlan run(const std::vector<std::size_t>& unsolved, const std::vector<std::size_t>& given_up) {
    standing_ = given_up;
    for (const std::size_t robot : unsolved) {
      if (!state_.trajectory(robot)) stand(robot);
    }
    stop_crossing_ones();
    progress_.update();
    while (plan_some()) {
    }
    std::sort(standing_.begin(), standing_.end());
    for (const std::size_t robot : standing_) completion_.unplanned.push_back(explain(robot));
    return std::move(completion_);
  }

 private:
  void stand(std::size_t robot) {
    state_.stand_for_ever(robot);
    standing_.push_back(robot);
  }

  void stop_crossing_ones() {
    for (std::size_t k = 0; k < standing_.size(); ++k) {  // standing_ grows
      for (const std::size_t crossing : state_.robots_conflicting_with_standing(standing_[k])) {
        if (state_.trajectory(crossing)) stand(crossing);
      }
    }
  }

  /// One round; true if it is worth another one.
  bool plan_some() {
    std::vector<std::size_t> still;
    for (const std::size_t robot : standing_) {
      if (!try_plan(robot)) still.push_back(robot);
    }
    const bool progress = still.size() < standing_.size() && !still.empty();
    standing_ = std::move(still);
    return progress && !completion_.cut_off;
  }

  bool try_plan(std::size_t robot) {
    if (stop_.met()) {
      completion_.cut_off = true;
      return false;
    }
    state_.leave(robot);
    SearchResult result = state_.plan(robot, {}, stop_);
    if (result.trajectory) {
      state_.follow(robot, std::move(*result.trajectory));
      progress_.update();
      return true;
    }
    state_.stand_for_ever(robot);
    no_way_[robot] = result.complete;
    completion_.cut_off = completion_.cut_off || !result.complete;
    return false;
  }

  Unplanned explain(std::size_t robot) {
    if (!no_way_[robot]) {
      return {robot, Reason::budget_exhausted, "The time budget ended before a way was found.", {}};
    }
    return {robot, Reason::blocked_by_robots, "No way was found that keeps clear of the other robots.",
            blockers(robot)};
  }

  /// Robots without which the robot would have a way: those on the way that it would take alone, except who
  /// could stay without robbing it of any.
  std::vector<std::size_t> blockers(std::size_t robot) {
    if (stop_.met()) {
      completion_.cut_off = true;
      return {};
    }
    std::vector<std::size_t> blockers = state_.conflicting_robots(robot, state_.alone(robot, stop_));
    state_.leave(robot);
    for (std::size_t k = 0; k < blockers.size() && blockers.size() > 1;) {
      if (stop_.met() || reduction_expansions_ > kMostReductionExpansions) break;
      const std::int64_t before = state_.expansions();
      std::vector<std::size_t> others = blockers;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
      if (state_.plan_ignoring(others, robot, {}, stop_).trajectory) {
        blockers = std::move(others);
      } else {
        ++k;
      }
      reduction_expansions_ += state_.expansions() - before;
    }
    state_.stand_for_ever(robot);
    completion_.cut_off = completion_.cut_off || stop_.met();
    return blockers;
  }

  PlanState& state_;
  const StopCondition& stop_;
  ProgressReport& progress_;
  std::vector<bool> no_way_;               // by robot: its last search ended without one
  std::int64_t reduction_expansions_ = 0;  // spent on finding out who is in whose way
  std::vector<std::size_t> standing_;
  PartialPlan completion_;
};

}  // namespace

PartialPlan make_partial_plan(PlanState& state, const std::vector<std::size_t>& unsolved,
                              const std::vector<std::size_t>& given_up, const StopCondition& stop,
                              ProgressReport& progress) {
  return Completing(state, stop, progress).run(unsolved, given_up);
}

}  // namespace fleetplan::core
