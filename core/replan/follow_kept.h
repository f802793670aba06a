#pragma once

// Plans that go on with what is kept of previous plans.

#include "core/model/plan.h"
#include "core/model/plan_options.h"
#include "core/model/problem.h"
#include "core/prioritized/plan_state.h"
#include "core/replan/kept_plans.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Lets the robots whose plans are kept follow them in `state`, except those whose plans conflict with a
/// robot that stays. Robots with `certain` plans, which hold if all others stay, follow them in any case.
/// Returns the number of robots that follow a plan.
std::size_t follow_kept_plans(PlanState& state, const KeptPlans& previous, const KeptPlans& certain);

/// Lets all of `movers`, whose plans are kept, follow them in `state`. Takes hardly any time, and no search
/// may follow.
void finish_with_kept_plans(PlanState& state, const std::vector<std::size_t>& movers);

/// Returns the plan for which no search is needed: parked robots, and robots whose previous plans hold while
/// all others stay at their starts or committed ends. The others are unplanned for lack of a budget, with
/// this detail. Takes as long as a few checks of the plans; none of the previous plans is kept if `stop` is
/// met first.
Plan plan_without_search(const Problem& problem, const PlanOptions& options, const char* detail,
                         const StopCondition& stop);

}  // namespace fleetplan::core
