#pragma once

#include <functional>

#include "api/endpoints/request_context.h"
#include "api/response/reply.h"
#include "core/runtime/work.h"

namespace fleetplan::api {

/// The reply of an endpoint, all of whose work is bounded by the Work that it gets: from the first byte of
/// the body to the last byte of the answer's text. It is granted `max_plan_memory`; the reply is 422
/// `memory_exceeded` if it needs more. The reply has the memory that is still in use, if it is much.
Reply bounded_work(const RequestContext& context, const std::function<Reply(core::Work&)>& endpoint);

/// The 422 for a request that needs more memory than it is granted.
Reply memory_exceeded(const RequestContext& context);

}  // namespace fleetplan::api
