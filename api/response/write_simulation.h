#pragma once

#include <optional>
#include <string>

#include "api/request/parse_request.h"
#include "core/execution/simulation/simulation.h"

namespace fleetplan::api {

/// Returns the `trace` of the answer; none if `stop` is met first.
std::optional<std::string> write_trace(const core::SimulationTrace& trace, const SimulateRequest& request,
                                       const core::StopCondition& stop);

/// Returns the answer of POST /v1/simulate. `trace`: its text, if there is one.
std::string write_simulation(const core::SimulationReport& report, const SimulateRequest& request,
                             const std::optional<std::string>& trace, const std::string& request_id);

}  // namespace fleetplan::api
