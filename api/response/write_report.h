#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/geometry/moving_obstacle.h"
#include "core/model/robot.h"
#include "core/verify/verify.h"

namespace fleetplan::api {

/// Returns the smallest clearance as answers report it, metres: contact, an overlap of at most
/// kContactTolerance, is 0.
std::optional<double> reported_clearance(const core::VerifyReport& report);

/// Returns the answer of POST /v1/validate. It contains at most the first twenty violations and the number of
/// all, with `"truncated": true` if there are more.
std::string write_report(const core::VerifyReport& report, const std::vector<core::Robot>& robots,
                         const std::vector<core::MovingObstacle>& obstacles,
                         const std::vector<core::Zone>& zones);

}  // namespace fleetplan::api
