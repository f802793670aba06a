#pragma once

#include <optional>
#include <string>
#include <vector>

#include "api/execution/parse_retime_request.h"
#include "core/execution/retime.h"

namespace fleetplan::api {

/// The answer of POST /v1/retime. `retimed`: by robot. Nothing if the stop is met.
std::optional<std::string> write_retimed(const RetimeRequest& request,
                                         const std::vector<core::RetimedRobot>& retimed, core::Work& stop);

}  // namespace fleetplan::api
