#pragma once

#include <vector>

#include "api/json/json_writer.h"
#include "core/execution/dependency.h"
#include "core/model/robot.h"

namespace fleetplan::api {

/// Writes the members `dependencies` and `tight`; without dependencies (null), both are null.
void write_dependencies(JsonWriter& json, const core::Dependencies* dependencies,
                        const std::vector<core::Robot>& robots);

}  // namespace fleetplan::api
