#include "server/ops/settings/config_file.h"

#include <CLI/CLI.hpp>
#include <exception>
#include <filesystem>
#include <set>
#include <system_error>
#include <vector>

#include "server/http/text.h"

namespace fleetplan::server {

namespace {

/// Throws an exception of CLI11 when the value is not valid for the option.
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

}  // namespace

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

}  // namespace fleetplan::server
