#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "server/command/command_io.h"
#include "server/service/service.h"

namespace fleetplan::server {

/// Runs `fleetplan COMMAND ...`, which answers one request from a file as the service would over HTTP.
/// Returns the exit code, or nothing if the arguments name no command: then they are settings of the server.
/// `make_service` is called only if the command needs the service.
std::optional<int> run_command(std::vector<std::string> arguments,
                               const std::function<Service()>& make_service, const Streams& streams);

}  // namespace fleetplan::server
