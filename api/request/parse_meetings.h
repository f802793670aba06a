#pragma once

#include <vector>

#include "api/json/json_reader.h"
#include "api/request/parse_body.h"
#include "core/model/plan.h"

namespace fleetplan::api {

/// Reads `unavoidable` of a request to validate (may be absent): meetings that the check exempts.
std::vector<core::Meeting> parse_meetings(const JsonReader& member, const Fleet& fleet);

/// Makes those robots invalid that `unplanned` of an answer lists as such. Whatever else it contains is
/// ignored.
void mark_invalid_robots(const JsonReader& unplanned, std::vector<core::Robot>& robots);

}  // namespace fleetplan::api
