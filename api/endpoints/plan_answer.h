#pragma once

#include <string>

#include "api/request/parse_request.h"
#include "api/response/reply.h"
#include "api/response/write_response.h"
#include "core/model/plan.h"

namespace fleetplan::api {

/// The answer with a plan: verify -> write. A plan that the checker rejects is a bug and becomes a 500.
/// `stages`: those before the plan was made.
Reply plan_answer(const core::Plan& plan, const PlanRequest& request, const std::string& request_id,
                  Stages stages);

}  // namespace fleetplan::api
