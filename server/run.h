#pragma once

#include "server/ops/settings/settings.h"
#include "server/service.h"

namespace fleetplan::server {

/// Serves until SIGTERM or SIGINT, then drains. Returns the exit code of the process: 0, or 1 when a port is
/// not available, stops accepting connections, or jobs did not end.
int run(const Settings& settings, Service service);

}  // namespace fleetplan::server
