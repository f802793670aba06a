#pragma once

#include <optional>
#include <string>

#include "api/request/parse_simulate_request.h"
#include "core/execution/simulation/simulation.h"

namespace fleetplan::api {

/// The answer of POST /v1/simulate.
std::string write_simulation(const core::SimulationReport& report, const SimulateRequest& request,
                             const std::optional<core::Simulator::Trace>& trace,
                             const std::string& request_id);

}  // namespace fleetplan::api
