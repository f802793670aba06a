#pragma once

#include <string>

#include "api/advance/parse_advance_request.h"

namespace fleetplan::api {

/// The request of the moment: that of the body with the starts, goals, committed and previous actions of
/// these robots, and what is left of its obstacles. Everything else is copied. The text ends anywhere once
/// the work is met.
std::string write_advanced(const AdvanceRequest& request, const std::vector<core::Robot>& robots,
                           core::Work& work);

}  // namespace fleetplan::api
