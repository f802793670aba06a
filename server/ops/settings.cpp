#include "server/ops/settings.h"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <system_error>
#include <vector>

#include "api/json/printable.h"
#include "server/http/request/access.h"
#include "server/http/static_files.h"
#include "server/http/text.h"
#include "server/ops/process.h"

namespace fleetplan::server {

namespace {

constexpr std::size_t kQueuePerWorker = 4;
constexpr std::size_t kMiB = 1 << 20;
constexpr std::int64_t kMaxMs = 86'400'000;       // a day
constexpr std::size_t kMaxItems = 1'000'000'000;  // the most items of a request

constexpr std::string_view kEnvironmentPrefix = "FLEETPLAN_";
constexpr const char* kDefaultBudget = "default-budget-ms";

/// Applies an item of a configuration file. Throws an exception of CLI11 when the value is not valid for the
/// option.
std::optional<std::string> apply(CLI::App& app, const CLI::ConfigItem& item) {
  CLI::Option* option =
      item.parents.empty() ? app.get_option_no_throw("--" + item.name) : nullptr;  // there are no sections
  if (option == nullptr || !option->get_configurable()) {
    return "there is no setting " + in_quotes(item.fullname());
  }
  // A line without '=' is reported as "true", which newer versions of CLI11 convert to the number 1.
  if (item.inputs == std::vector<std::string>{"true"}) return in_quotes(item.name) + " has no value";
  if (option->count() > 0) return std::nullopt;
  option->add_result(item.inputs);
  option->run_callback();
  return std::nullopt;
}

/// Gives options of `app` that are not set yet the values of a file of `flag = value` lines, `#` for comments
/// (TOML, as far as CLI11 reads it). Call it after `app` has parsed flags and environment, which have
/// precedence. Returns the fault of the file, if there is one.
std::optional<std::string> apply_config_file(CLI::App& app, const std::string& path) {
  const auto fault = [&](const std::string& what) { return "--config: " + path + ": " + what; };
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) return fault("it is a folder");
  std::set<std::string> seen;
  try {
    for (const CLI::ConfigItem& item : CLI::ConfigTOML().from_file(path)) {
      if (!seen.insert(item.fullname()).second) return fault(in_quotes(item.name) + " is set twice");
      if (const auto wrong = apply(app, item)) return fault(*wrong);
    }
  } catch (const CLI::FileError&) {
    return fault("it cannot be read");
  } catch (const std::exception& error) {  // newer versions of CLI11 throw others for broken syntax
    return fault(error.what());
  }
  return std::nullopt;
}

std::string environment_name(std::string flag) {
  for (char& c : flag) c = c == '-' ? '_' : static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return std::string(kEnvironmentPrefix) + flag;
}

template <typename T>
CLI::Option* add_flag(CLI::App& app, const std::string& flag, T& value, const std::string& description) {
  return app.add_option("--" + flag, value, description)
      ->envname(environment_name(flag))
      ->capture_default_str();
}

template <typename T>
CLI::Option* add_number(CLI::App& app, const std::string& flag, T& value, T smallest, T largest,
                        const std::string& description) {
  return add_flag(app, flag, value, description)->check(CLI::Range(smallest, largest));
}

CLI::Option* add_size(CLI::App& app, const std::string& flag, std::size_t& bytes,
                      const std::string& shown_default, const std::string& description) {
  return add_flag(app, flag, bytes, description + "; accepts KiB, MiB and GiB")
      ->transform(CLI::AsSizeValue(false))
      ->default_str(shown_default);
}

/// Returns the fault of a number of bytes that is not in the range, which `range` says in words.
std::optional<std::string> size_fault(const std::string& flag, std::size_t bytes, std::size_t least,
                                      const std::string& range) {
  constexpr std::size_t kMax = std::size_t{1} << 40;
  if (bytes >= least && bytes <= kMax) return std::nullopt;
  return "--" + flag + " must be " + range;
}

/// Returns the names of all environment variables with the prefix of settings.
std::vector<std::string> prefixed_variables() {
  std::vector<std::string> names;
  for (char** variable = environ; *variable != nullptr; ++variable) {
    const std::string_view text = *variable;
    if (text.starts_with(kEnvironmentPrefix)) names.emplace_back(text.substr(0, text.find('=')));
  }
  return names;
}

/// Flags with their environment names, and values that need conversion before they go into Settings.
class Flags {
 public:
  Flags() : app_("Fleetplan: collision-free timed motions for fleets of robots, over HTTP.", "fleetplan") {
    app_.set_version_flag("--version", std::string("fleetplan ") + kVersion);
    app_.get_formatter()->column_width(36);
    app_.footer("`fleetplan help` lists the commands that answer requests from files, without a server.");
    settings_.web_root = default_web_root().string();
    add_serving();
    add_access();
    add_workers_flag(app_, settings_.workers);
    add_sizes();
    add_limit_flags(app_, settings_.limits);
    add_times();
    app_.add_flag("--healthcheck", settings_.healthcheck,
                  "Check whether the service with this host and these ports is alive: exit code 0, or 1")
        ->configurable(false);
    config_option_ =
        add("config", config_, "File of 'flag = value' lines; flags and the environment override it")
            ->configurable(false);
  }

  std::variant<Settings, SettingsExit> parse(std::vector<std::string> arguments) {
    std::reverse(arguments.begin(), arguments.end());  // the order that CLI11 expects
    try {
      app_.parse(std::move(arguments));
    } catch (const CLI::ParseError& error) {
      std::ostringstream text;
      const int code = app_.exit(error, text, text);
      return SettingsExit{code == 0 ? 0 : 2, api::printable(text.str(), api::Lines::kept)};
    }
    if (const auto ignored = ignored_environment(app_)) return bad(*ignored);
    if (config_option_->count() > 0) {
      if (const auto fault = apply_config_file(app_, config_)) return bad(*fault);
    }
    return finish();
  }

 private:
  /// Returns the variables that are named like settings, but are none: most probably misspelt.
  std::vector<std::string> unknown_environment() const {
    std::vector<std::string> unknown = prefixed_variables();
    for (const CLI::Option* option : app_.get_options()) std::erase(unknown, option->get_envname());
    return unknown;
  }

  template <typename T>
  CLI::Option* add(const std::string& flag, T& value, const std::string& description) {
    return add_flag(app_, flag, value, description);
  }

  void add_serving() {
    add("host", settings_.host, "Address to listen on");
    add_number(app_, "port", settings_.port, 0, 65535, "Port to listen on, 0 for any free one");
    admin_ = add_number(app_, "admin-port", admin_port_, 0, 65535,
                        "Separate port for health, readiness and metrics, 0 for any free one")
                 ->default_str("off");
    queue_ =
        add_number<std::size_t>(app_, "queue", settings_.queue, 0, 100'000, "Jobs that may wait for a worker")
            ->default_str("4 for each worker");
    add_number<std::size_t>(app_, "connections", settings_.connections, 1, 65'536,
                            "Requests served at a time; four times as many connections may be open");
    add("log-level", settings_.log_level, "What to log")
        ->check(CLI::IsMember({"trace", "debug", "info", "warn", "error", "critical", "off"}));
    add("web-root", settings_.web_root, "Folder of the page");
  }

  void add_access() {
    token_option_ = add("auth-token-file", token_file_,
                        "File with the token that requests must send, except for health and readiness");
    add("cors-origin", settings_.cors_origins,
        "Origins whose pages may use the service from a browser, comma-separated or repeated; * for any")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->default_str("none");
    add("frame-ancestors", settings_.frame_ancestors,
        "Origins whose pages may show the page in a frame, comma-separated or repeated; * for any")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->default_str("none");
    add("trusted-proxy", trusted_proxies_,
        "Addresses (10.0.0.7, 10.0.0.0/8) of proxies whose X-Forwarded-For names the client, comma-separated "
        "or repeated")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->default_str("none");
    add("allowed-hosts", settings_.allowed_hosts,
        "On a loopback host: names besides local ones by which requests may address the service, "
        "comma-separated or repeated; * for any")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->default_str("none");
  }

  void add_sizes() {
    add_size(app_, "max-body", settings_.limits.max_body, "32MiB",
             "Largest body in bytes after decompression");
    add_size(app_, "map-cache", settings_.map_cache, "128MiB",
             "Memory of maps that are kept for later requests, in bytes, 0 for none");
    add_size(app_, "max-unsent", settings_.max_unsent, "64MiB",
             "Memory of answers that clients have not accepted yet, in bytes");
  }

  void add_times() {
    add_number<std::int64_t>(app_, "idle-timeout-ms", idle_timeout_ms_, 1, kMaxMs,
                             "An idle connection is closed after this");
    add_number<std::int64_t>(
        app_, "read-timeout-ms", read_timeout_ms_, 1, kMaxMs,
        "A request's head must arrive within this; its body may pause for as long and fall "
        "as far behind 100 kB/s");
    add_number<std::int64_t>(app_, "drain-ms", drain_ms_, 0, kMaxMs, "Time for running plans after SIGTERM");
    add_number<std::int64_t>(app_, "drain-delay-ms", drain_delay_ms_, 0, kMaxMs,
                             "Time before that, not ready but serving, so that load balancers notice");
  }

  std::variant<Settings, SettingsExit> finish() {
    std::error_code ignored;
    if (!settings_.web_root.empty() && !std::filesystem::is_directory(settings_.web_root, ignored)) {
      return bad("--web-root: '" + settings_.web_root + "' is not a folder");
    }
    if (const auto fault = finish_access()) return bad(*fault);
    if (const auto fault = size_fault("max-body", settings_.limits.max_body, 1, "1 byte to 1 TiB"))
      return bad(*fault);
    if (const auto fault = size_fault("map-cache", settings_.map_cache, 0, "at most 1 TiB"))
      return bad(*fault);
    if (const auto fault = size_fault("max-unsent", settings_.max_unsent, kMiB, "1 MiB to 1 TiB"))
      return bad(*fault);
    if (const auto fault = settle_limits(app_, settings_.limits)) return bad(*fault);
    if (queue_->count() == 0) settings_.queue = kQueuePerWorker * static_cast<std::size_t>(settings_.workers);
    settings_.idle_timeout = std::chrono::milliseconds(idle_timeout_ms_);
    settings_.read_timeout = std::chrono::milliseconds(read_timeout_ms_);
    settings_.drain = std::chrono::milliseconds(drain_ms_);
    settings_.drain_delay = std::chrono::milliseconds(drain_delay_ms_);
    settings_.unknown_variables = unknown_environment();
    if (admin_->count() > 0) settings_.admin_port = admin_port_;
    return settings_;
  }

  std::optional<std::string> finish_access() {
    for (const std::string& origin : settings_.cors_origins) {
      if (const auto fault = origin_fault(origin)) return "--cors-origin: " + *fault;
    }
    for (const std::string& origin : settings_.frame_ancestors) {
      if (const auto fault = origin_fault(origin)) return "--frame-ancestors: " + *fault;
    }
    for (const std::string& text : trusted_proxies_) {
      const auto range = AddressRange::from_text(text);
      if (!range) return "--trusted-proxy: '" + text + "' is not an address or a range such as 10.0.0.0/8";
      settings_.trusted_proxies.push_back(*range);
    }
    for (const std::string& name : settings_.allowed_hosts) {
      if (const auto fault = host_name_fault(name)) return "--allowed-hosts: " + *fault;
    }
    if (token_option_->count() == 0) return std::nullopt;
    auto token = AccessToken::from_file(token_file_);
    if (const auto* fault = std::get_if<std::string>(&token)) {
      return "--auth-token-file: " + token_file_ + ": " + *fault;
    }
    settings_.token = std::get<AccessToken>(std::move(token));
    return std::nullopt;
  }

  static SettingsExit bad(const std::string& message) {
    return {2, api::printable(message) + "\nRun with --help for more information.\n"};
  }

  CLI::App app_;
  Settings settings_;
  std::int64_t idle_timeout_ms_ = Settings{}.idle_timeout.count();
  std::int64_t read_timeout_ms_ = Settings{}.read_timeout.count();
  std::int64_t drain_ms_ = Settings{}.drain.count();
  std::int64_t drain_delay_ms_ = Settings{}.drain_delay.count();
  int admin_port_ = 0;
  std::vector<std::string> trusted_proxies_;
  std::string token_file_;
  CLI::Option* token_option_ = nullptr;
  std::string config_;
  CLI::Option* config_option_ = nullptr;
  CLI::Option* admin_ = nullptr;
  CLI::Option* queue_ = nullptr;
};

}  // namespace

std::optional<std::string> ignored_environment(const CLI::App& app) {
  for (const CLI::Option* option : app.get_options()) {
    const char* value = option->get_envname().empty() ? nullptr : std::getenv(option->get_envname().c_str());
    if (value == nullptr || *value == '\0' || option->count() > 0) continue;
    return option->get_envname() + ": '" + value + "' is not a valid value for " + option->get_name();
  }
  return std::nullopt;
}

void add_workers_flag(CLI::App& app, int& workers) {
  workers = cpus_granted();
  add_number(app, "workers", workers, 1, 1024,
             "Planning threads, by default the CPUs granted; idle ones help with anytime plans");
}

void add_limit_flags(CLI::App& app, api::Limits& limits) {
  add_size(app, "max-plan-memory", limits.max_plan_memory, "256MiB",
           "Most memory of a plan in bytes, from the parsed body to the answer");
  add_number<std::int64_t>(app, "max-cells", limits.max_cells, 1, 1'000'000'000, "Most cells of a map");
  add_number<std::size_t>(app, "max-robots", limits.max_robots, 1, 1'000'000, "Most robots of a request");
  add_number<std::size_t>(app, "max-goals", limits.max_goals, 1, kMaxItems,
                          "Most goals in lists of a request");
  add_number<std::size_t>(app, "max-actions", limits.max_actions, 1, kMaxItems,
                          "Most committed and previous actions of a request");
  add_number<std::size_t>(app, "max-obstacles", limits.max_obstacles, 1, 1'000'000,
                          "Most moving obstacles of a request");
  add_number<std::size_t>(app, "max-obstacle-entries", limits.max_obstacle_entries, 1, kMaxItems,
                          "Most entries of the motion of all obstacles");
  add_number<std::size_t>(app, "max-zones", limits.max_zones, 1, 1'000'000, "Most zones of a request");
  add_number<std::size_t>(app, "max-zone-corners", limits.max_zone_corners, 3, kMaxItems,
                          "Most corners of the polygons of all zones");
  add_number(app, "max-depth", limits.max_depth, 4, 512, "Deepest nesting of the JSON");
  add_number<std::int64_t>(app, kDefaultBudget, limits.default_budget_ms, 1, kMaxMs,
                           "Time for a plan whose request sets none");
  add_number<std::int64_t>(app, "max-budget-ms", limits.max_budget_ms, 1, kMaxMs, "Longest time for a plan");
}

std::optional<std::string> settle_limits(const CLI::App& app, api::Limits& limits) {
  if (auto fault = size_fault("max-plan-memory", limits.max_plan_memory, kMiB, "1 MiB to 1 TiB"))
    return fault;
  const bool sets_default = app.get_option("--" + std::string(kDefaultBudget))->count() > 0;
  if (sets_default && limits.default_budget_ms > limits.max_budget_ms) {
    return "--default-budget-ms is greater than --max-budget-ms";
  }
  limits.default_budget_ms = std::min(limits.default_budget_ms, limits.max_budget_ms);
  return std::nullopt;
}

std::variant<Settings, SettingsExit> parse_settings(std::vector<std::string> arguments) {
  return Flags().parse(std::move(arguments));
}

}  // namespace fleetplan::server
