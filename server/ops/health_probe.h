#pragma once

#include <optional>
#include <string>

#include "server/ops/settings.h"

namespace fleetplan::server {

/// Requests /healthz of the service that runs with these settings, perhaps in another process: on the admin
/// port if there is one, which answers however busy the main port is. Returns the fault, if there is one.
///
/// The probe is for liveness, not readiness: restarting a container because it drains or its queue is full
/// would lose its running plans.
std::optional<std::string> health_fault(const Settings& settings);

}  // namespace fleetplan::server
