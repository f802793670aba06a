#pragma once

#include "core/prioritized/plan_state.h"
#include "core/replan/kept_plans.h"

namespace fleetplan::core {

/// The robots whose plans are kept follow them in `state`, except those whose plans conflict with a robot
/// that stays or with the committed motion of a robot that has to be planned. Returns the number of those
/// that do.
std::size_t follow_kept_plans(PlanState& state, const KeptPlans& previous);

/// The same where all of `movers` are kept and no search follows: takes hardly any time.
void finish_with_kept_plans(PlanState& state, const std::vector<std::size_t>& movers);

}  // namespace fleetplan::core
