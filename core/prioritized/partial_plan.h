#pragma once

#include <cstddef>
#include <vector>

#include "core/model/plan.h"
#include "core/prioritized/plan_state.h"
#include "core/prioritized/progress_report.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

struct PartialPlan {
  std::vector<Unplanned> unplanned;  // ascending
  bool cut_off = false;              // the stop condition decided something
};

/// Makes a safe partial plan. Robots of `unsolved` may have a trajectory; those of `given_up` stay at their
/// starts already. First, all robots without a trajectory stay at their starts, and so do robots whose
/// trajectories conflict with one that stays. Then those that stay are planned again one by one, as long as
/// that gives a robot a trajectory. The plan is safe after every step; once `stop` is met, no search starts.
PartialPlan make_partial_plan(PlanState& state, const std::vector<std::size_t>& unsolved,
                              const std::vector<std::size_t>& given_up, const StopCondition& stop,
                              ProgressReport& progress);

}  // namespace fleetplan::core
