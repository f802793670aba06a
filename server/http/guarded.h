#pragma once

#include <functional>
#include <string>

#include "api/response/reply.h"
#include "server/ops/request_log.h"

namespace fleetplan::server {

/// What `work` returns. The one place where an exception, which means a bug, becomes a 500; what it says is
/// for the log only.
api::Reply guarded(const RequestLog& log, const std::string& request_id,
                   const std::function<api::Reply()>& work);

}  // namespace fleetplan::server
