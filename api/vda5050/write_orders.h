#pragma once

#include <optional>
#include <string>

#include "api/json/json_writer.h"
#include "api/vda5050/parse_vda5050_request.h"

namespace fleetplan::api {

/// Returns the answer of POST /v1/export/vda5050: an order for each robot with actions that has none, and an
/// update for each one of whose order more nodes can be released. With each, it tells what its nodes mean for
/// the plan. If orders have to be cancelled, it has the messages for that instead: until these vehicles
/// stand, nobody may go on by this plan, as they are not where it has them. Returns none if the stop is met.
std::optional<std::string> write_orders(const VdaRequest& request, core::Work& stop);

/// Writes the members `action` and `progress` of a place.
void write_place(JsonWriter& json, const core::ActionPlace& place);

}  // namespace fleetplan::api
