#pragma once

#include <nlohmann/json.hpp>

namespace fleetplan::api {

/// The document's `components.responses`, from the table of errors: one for each status.
nlohmann::ordered_json error_responses();

}  // namespace fleetplan::api
