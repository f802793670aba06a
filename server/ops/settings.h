#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "api/request/limits.h"
#include "server/http/request/access.h"

namespace CLI {
class App;
}

namespace fleetplan::server {

/// Everything an operator may set. The defaults here are the defaults of the flags.
struct Settings {
  std::string host = "127.0.0.1";
  int port = 8080;                               // 0: any free one
  std::optional<int> admin_port = std::nullopt;  // for health, readiness and metrics; 0: any free one
  int workers = 1;                               // planning threads; the flag's default: the CPUs granted
  std::size_t queue = 4;                         // jobs that may wait; the flag's default: 4 for each worker
  std::size_t connections = 1024;
  api::Limits limits;
  std::size_t map_cache = 128u << 20;               // bytes of maps that are kept; 0: none
  std::size_t max_unsent = 64u << 20;               // bytes of answers that clients have not accepted yet
  std::chrono::milliseconds idle_timeout{1000};     // for a connection between requests
  std::chrono::milliseconds read_timeout{10'000};   // for a request's head; see also read_body
  std::chrono::milliseconds drain{10'000};          // for running jobs after SIGTERM
  std::chrono::milliseconds drain_delay{0};         // time before the drain: not ready, but serving
  std::optional<AccessToken> token = std::nullopt;  // required for all requests except health and readiness
  std::vector<std::string> cors_origins = {};       // see CrossOrigin
  std::vector<std::string> frame_ancestors = {};    // origins whose pages may frame the page; * for any
  std::vector<AddressRange> trusted_proxies = {};   // proxies whose X-Forwarded-For names the client
  std::vector<std::string> allowed_hosts = {};      // see AllowedHosts
  std::string log_level = "info";
  std::string web_root;                             // empty: no page
  std::vector<std::string> unknown_variables = {};  // variables named like settings, but none
  bool healthcheck = false;  // probe the service that runs with these settings instead of serving
};

/// Why the process should end instead of serving: help, version, or a bad value.
struct SettingsExit {
  int code;  // 0, or 2 for a bad value
  std::string text;
};

/// Returns the settings. The sources, in this order of precedence:
///
/// 1. flags (without the program's name),
/// 2. the environment (`FLEETPLAN_` and the flag in capitals; an empty variable counts as not set),
/// 3. the file of --config,
/// 4. and defaults.
std::variant<Settings, SettingsExit> parse_settings(std::vector<std::string> arguments);

// Flags, and their environment variables, that commands without a server also have. The variables that they
// set must outlive `app`.
/// Adds the flag of the planning threads. The default is one for each CPU granted.
void add_workers_flag(CLI::App& app, int& workers);
/// Adds the flags of the limits of a request, except for its size.
void add_limit_flags(CLI::App& app, api::Limits& limits);
/// Makes the limits agree once `app` has parsed them. Returns the fault if they are out of range.
std::optional<std::string> settle_limits(const CLI::App& app, api::Limits& limits);
/// Returns the fault of a bad value from the environment, which newer versions of CLI11 silently ignore.
std::optional<std::string> ignored_environment(const CLI::App& app);

}  // namespace fleetplan::server
