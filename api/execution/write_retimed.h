#pragma once

#include <string>
#include <vector>

#include "api/execution/parse_retime_request.h"
#include "core/execution/retime.h"

namespace fleetplan::api {

/// The answer of POST /v1/retime. `retimed`: by robot.
std::string write_retimed(const RetimeRequest& request, const std::vector<core::RetimedRobot>& retimed);

}  // namespace fleetplan::api
