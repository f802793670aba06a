#pragma once

#include <string>

#include "api/advance/parse_advance_request.h"

namespace fleetplan::api {

/// The request of the moment: that of the body, with other starts, goals, committed and previous actions, and
/// obstacles. Everything else is copied.
std::string write_advanced(const AdvanceRequest& request);

}  // namespace fleetplan::api
