#pragma once

#include <optional>
#include <string>

#include "server/ops/settings/settings.h"

namespace fleetplan::server {

/// Asks the service that runs with these settings, perhaps in another process, for /healthz: on the admin
/// port if there is one, which answers however busy the other is. What is wrong, if anything is.
///
/// That is whether it is alive, not whether it is ready: to restart a container since it drains, or since its
/// queue is full, would lose the plans that it has.
std::optional<std::string> health_fault(const Settings& settings);

}  // namespace fleetplan::server
