#pragma once

#include <exception>
#include <string>

#include "api/response/reply.h"
#include "server/ops/request_log.h"

namespace fleetplan::server {

/// The 500 that answers an exception, which means a bug. The exception's text goes to the log only.
api::Reply internal_error(const RequestLog& log, const std::string& request_id,
                          const std::exception_ptr& failure);

}  // namespace fleetplan::server
