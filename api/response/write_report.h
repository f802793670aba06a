#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/model/robot.h"
#include "core/verify/verify.h"

namespace fleetplan::api {

/// The smallest clearance as it is told, metres: contact, which the search leaves to within
/// kContactTolerance, is 0.
std::optional<double> told_clearance(const core::VerifyReport& report);

/// The answer of POST /v1/validate. Of very many violations only the first thousand are written, and
/// `"truncated": true` says so.
std::string write_report(const core::VerifyReport& report, const std::vector<core::Robot>& robots);

}  // namespace fleetplan::api
