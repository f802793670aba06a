#pragma once

#include <functional>

#include "api/endpoints/request_context.h"
#include "api/response/reply.h"

namespace fleetplan::api {

/// The reply of an endpoint's work, which is granted `max_plan_memory` (see core::MemoryAccount). 422
/// `memory_exceeded` if it needs more.
Reply within_memory(const RequestContext& context, const std::function<Reply()>& work);

}  // namespace fleetplan::api
