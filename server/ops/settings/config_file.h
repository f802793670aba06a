#pragma once

#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace fleetplan::server {

/// Gives options of `app` that are not set yet the values of a file of `flag = value` lines, `#` for comments
/// (TOML, as far as CLI11 reads it). Call it after `app` has parsed flags and environment, which have
/// precedence. The fault of the file, if there is one.
std::optional<std::string> apply_config_file(CLI::App& app, const std::string& path);

}  // namespace fleetplan::server
