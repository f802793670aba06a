#pragma once

#include "api/json/json_reader.h"
#include "core/execution/simulation/disturbance.h"

namespace fleetplan::api {

/// Reads the member `disturbance` of a request to simulate; what is left out disturbs nothing.
core::Disturbance parse_disturbance(const JsonReader& member);

}  // namespace fleetplan::api
