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
  bool cut_off = false;
};

/// Makes a safe partial plan. Robots of `unsolved` may have a trajectory, those of `given_up` stand at
/// their starts already. At first all without a trajectory stand for ever, and so do robots whose
/// trajectories cross a standing one; then they are planned again one after the other among everybody,
/// standing robots included, as long as that gets anybody a trajectory. So the plan is safe at any moment;
/// once `stop` is met, nothing is searched any more.
PartialPlan make_partial_plan(PlanState& state, const std::vector<std::size_t>& unsolved,
                              const std::vector<std::size_t>& given_up, const StopCondition& stop,
                              ProgressReport& progress);

}  // namespace fleetplan::core
