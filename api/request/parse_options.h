#pragma once

#include <chrono>

#include "api/json/fault_list.h"
#include "api/json/json_path.h"
#include "api/json/json_value.h"
#include "api/request/limits.h"
#include "api/request/option_table.h"

namespace fleetplan::api {

/// Reads `options`; what is left out has its default.
ReadOptions parse_options(const JsonValue& value, const JsonPath& path, FaultList& faults);

/// The smaller of the budget that the options want, or the default one, and the service's largest. Where that
/// is less than was wanted, it adds a warning.
std::chrono::nanoseconds effective_budget(ReadOptions& options, const Limits& limits);

}  // namespace fleetplan::api
