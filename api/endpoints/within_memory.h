#pragma once

#include <functional>

#include "api/endpoints/request_context.h"
#include "api/response/reply.h"

namespace fleetplan::api {

/// The reply of an endpoint's work, which is granted `max_plan_memory` (see core::MemoryAccount). 422
/// `memory_exceeded` if it needs more. The reply has the memory that is still in use, if it is much.
Reply within_memory(const RequestContext& context, const std::function<Reply()>& work);

/// That 422.
Reply memory_exceeded(const RequestContext& context);

}  // namespace fleetplan::api
