#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "api/json/json_reader.h"
#include "api/request/limits.h"
#include "api/request/option_table.h"

namespace fleetplan::api {

/// Reads the member `options`, by the table of options; what is left out has its default.
ReadOptions parse_options(const JsonReader& member);

/// The requested budget, or the default one, but at most the service's maximum.
std::chrono::nanoseconds effective_budget(const ReadOptions& options, const Limits& limits);

/// The warning of a budget that is less than requested.
std::optional<std::string> budget_warning(const ReadOptions& options, const Limits& limits);

}  // namespace fleetplan::api
