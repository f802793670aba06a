#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "api/json/fault_list.h"
#include "api/json/json_path.h"
#include "api/json/json_value.h"
#include "api/request/limits.h"
#include "core/model/plan_options.h"

namespace fleetplan::api {

/// The member `options` of a request.
struct ReadOptions {
  core::PlanOptions plan;
  std::optional<double> budget_ms;    // as the request wants it, >= 1
  std::vector<std::string> warnings;  // what was accepted but will not have the effect that it seems to have
};

/// Reads `options`; what is left out has its default.
ReadOptions parse_options(const JsonValue& value, const JsonPath& path, FaultList& faults);

/// The smaller of the budget that the options want, or the default one, and the service's largest. Where that
/// is less than was wanted, it adds a warning.
std::chrono::nanoseconds effective_budget(ReadOptions& options, const Limits& limits);

}  // namespace fleetplan::api
