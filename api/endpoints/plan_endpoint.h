#pragma once

#include <functional>
#include <string_view>

#include "api/endpoints/request_context.h"
#include "api/response/reply.h"
#include "core/planner.h"

namespace fleetplan::api {

/// The planner: core::plan, or a stub in tests.
using Planner = std::function<core::Plan(const core::Problem&, const core::PlanOptions&,
                                         const core::StopCondition&, core::Observer*)>;

/// POST /v1/plan: parse -> plan -> verify -> write. Never throws for what a client sent; a plan that the
/// checker rejects becomes a 500. Reports progress to the context's events.
Reply plan_endpoint(std::string_view body, const RequestContext& context);

/// The same with any planner.
Reply plan_with(const Planner& planner, std::string_view body, const RequestContext& context);

}  // namespace fleetplan::api
