#pragma once

#include <functional>
#include <string_view>

#include "api/endpoints/request_context.h"
#include "api/response/reply.h"
#include "core/planner.h"

namespace fleetplan::api {

/// What plans: core::plan, or a stand-in.
using Planner = std::function<core::Plan(const core::Problem&, const core::PlanOptions&,
                                         const core::StopCondition&, core::Observer*)>;

/// POST /v1/plan: parse -> plan -> verify -> write. Never throws for what a client sent; a plan that the
/// checker refuses becomes a 500. What happens meanwhile is told to the context's events.
Reply plan_endpoint(std::string_view body, const RequestContext& context);

/// The same with another planner.
Reply plan_with(const Planner& planner, std::string_view body, const RequestContext& context);

}  // namespace fleetplan::api
