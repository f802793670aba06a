#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "core/model/plan_options.h"
#include "core/model/problem.h"
#include "core/model/robot.h"
#include "core/runtime/executor.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Goals that one robot is to visit in their order, after those that it has.
struct Task {
  std::vector<Goal> goals;          // at least one
  std::vector<std::size_t> robots;  // that may do it, ascending
};

/// Returns when robots would rest in the last pose of tasks, by task, then as in Task::robots: seconds, or
/// kForever where there is no way. Each robot is alone, visits the goals that are left to it after its
/// committed actions, and then those of the task. Services and `not_before` count; ways take their
/// travel_times(), so a goal without a heading is left in any heading. None if `stop` is met first, or if
/// `go_on` ends it, see travel_times().
std::optional<std::vector<std::vector<double>>> arrivals(const Problem& problem, const PlanOptions& options,
                                                         const std::vector<Task>& tasks,
                                                         const StopCondition& stop, Executor& executor,
                                                         const std::function<bool()>& go_on);

}  // namespace fleetplan::core
