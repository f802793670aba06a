#pragma once

#include "core/prioritized/plan_state.h"
#include "core/replan/kept_plans.h"

namespace fleetplan::core {

/// The robots whose plans are kept follow them in `state`, except those whose plans conflict with a robot
/// that stays. Those of `certain` plans, which hold if all others stay, follow them in any case. Returns the
/// number of those that do.
std::size_t follow_kept_plans(PlanState& state, const KeptPlans& previous, const KeptPlans& certain);

/// The same where all of `movers` are kept and no search follows: takes hardly any time.
void finish_with_kept_plans(PlanState& state, const std::vector<std::size_t>& movers);

}  // namespace fleetplan::core
