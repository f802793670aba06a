#pragma once

#include <nlohmann/json.hpp>

namespace fleetplan::api {

/// The schema PlanOptions, from the table of options. `x-unit`: the unit's symbol; `x-enumDescriptions`: what
/// each word means.
nlohmann::ordered_json options_schema();

}  // namespace fleetplan::api
