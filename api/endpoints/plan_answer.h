#pragma once

#include <string>

#include "api/endpoints/request_context.h"
#include "api/request/parse_request.h"
#include "api/response/reply.h"
#include "api/response/write_response.h"
#include "core/model/plan.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::api {

/// The answer with a plan: verify -> write. A plan that the checker rejects is a bug and becomes a 500. If
/// the check is not finished soon after `stop`, by which the plan was made, no robot that moves is planned: a
/// plan that is not checked is never returned. `stages`: those before the plan was made. `on_answer` gets the
/// plan of the answer; may be empty.
Reply plan_answer(const core::Plan& plan, const PlanRequest& request, const std::string& request_id,
                  Stages stages, const core::StopCondition& stop, const AnsweredPlan& on_answer = {});

}  // namespace fleetplan::api
