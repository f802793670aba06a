#include "core/search/complete.h"

#include <algorithm>
#include <deque>
#include <utility>

namespace fleetplan::core {
namespace {

class Completing {
 public:
  Completing(FleetState& state, const StopCondition& stop) : state_(state), stop_(stop) {}

  Completion run(const PriorityOrder& order, const std::vector<std::size_t>& hopeless) {
    for (const std::size_t robot : order) {
      if (!state_.trajectory(robot)) enqueue(robot);
    }
    while (!pending_.empty()) {
      const std::size_t robot = pending_.front();
      pending_.pop_front();
      state_.leave(robot);
      if (!try_plan(robot)) give_up(robot);
    }
    given_up_.insert(given_up_.end(), hopeless.begin(), hopeless.end());
    std::sort(given_up_.begin(), given_up_.end());
    retry();
    for (const std::size_t robot : given_up_) explain(robot);
    return std::move(completion_);
  }

 private:
  void enqueue(std::size_t robot) {
    pending_.push_back(robot);
    state_.block_start(robot, state_.fleet().options().start_safe_interval);
  }

  bool try_plan(std::size_t robot) {
    if (stop_.met()) {
      completion_.cut_off = true;
      return false;
    }
    SearchResult result = state_.plan(robot, {}, stop_);
    if (!result.complete) completion_.cut_off = true;
    if (!result.trajectory) return false;
    state_.follow(robot, std::move(*result.trajectory));
    return true;
  }

  void give_up(std::size_t robot) {
    given_up_.push_back(robot);
    state_.stand_for_ever(robot);
    for (const std::size_t crossing : state_.in_the_way_of_standing(robot)) {
      if (state_.trajectory(crossing)) enqueue(crossing);
    }
  }

  /// Others were given up since, so there may be a way now.
  void retry() {
    std::vector<std::size_t> still;
    for (const std::size_t robot : given_up_) {
      state_.leave(robot);
      if (try_plan(robot)) continue;
      state_.stand_for_ever(robot);
      still.push_back(robot);
    }
    given_up_ = std::move(still);
  }

  void explain(std::size_t robot) {
    if (stop_.met()) {
      completion_.unplanned.push_back(
          {robot, Unplanned::Reason::budget_exhausted, "the time budget ended before a way was found", {}});
      return;
    }
    completion_.unplanned.push_back({robot, Unplanned::Reason::blocked_by_robots,
                                     "no way was found that keeps clear of the other robots",
                                     state_.in_the_way(robot, state_.alone(robot, stop_))});
  }

  FleetState& state_;
  const StopCondition& stop_;
  std::deque<std::size_t> pending_;
  std::vector<std::size_t> given_up_;
  Completion completion_;
};

}  // namespace

Completion complete(FleetState& state, const PriorityOrder& order, const std::vector<std::size_t>& hopeless,
                    const StopCondition& stop) {
  return Completing(state, stop).run(order, hopeless);
}

}  // namespace fleetplan::core
