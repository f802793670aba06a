#pragma once

#include <string>

#include "server/command/command_io.h"

namespace fleetplan::server {

/// `fleetplan map2request`: writes a request of /v1/plan for a map of ROS and a table of robots. Refuses what
/// the service would, with the file and the line of each fault. Returns the exit code.
int map_to_request(const std::string& yaml, const std::string& robots, const std::string& output,
                   const Streams& streams);

}  // namespace fleetplan::server
