#include "api/parse_request.h"

#include <algorithm>
#include <array>
#include <utility>

#include "api/make_problem.h"
#include "api/text.h"

namespace fleetplan::api {

namespace {

constexpr std::array<std::string_view, 4> kMembers{"map", "robot_defaults", "robots", "options"};

std::chrono::nanoseconds effective_budget(ReadOptions& options, const Limits& limits) {
  const auto most = static_cast<double>(limits.max_budget_ms);
  const double wanted = options.budget_ms.value_or(static_cast<double>(limits.default_budget_ms));
  if (options.budget_ms && wanted > most) {
    options.warnings.push_back("time_budget_ms was clamped from " + number_text(wanted) + " to " +
                               std::to_string(limits.max_budget_ms) + ", the most that this service grants.");
  }
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
      std::chrono::duration<double, std::milli>(std::min(wanted, most)));
}

}  // namespace

std::variant<PlanRequest, RequestError> parse_request(std::string_view body, const Limits& limits) {
  auto read = read_json(body, limits.max_depth);
  if (const auto* error = std::get_if<JsonError>(&read)) return refusal(*error);
  JsonDocument document = std::get<JsonDocument>(std::move(read));
  FaultList& faults = document.faults;

  const JsonPath path;
  const ObjectReader root(document.root, path, kMembers, faults);
  Fleet fleet = parse_fleet(root, limits, faults);
  if (!fleet.map) return refusal(faults);
  const WorldFrame frame = fleet.map->frame;
  auto problem = make_problem(std::move(fleet.map->grid), std::move(fleet.robots), faults);
  if (!problem) return refusal(faults);
  const auto budget = effective_budget(fleet.options, limits);
  return PlanRequest{std::move(*problem), fleet.options.plan, budget, frame,
                     std::move(fleet.options.warnings)};
}

}  // namespace fleetplan::api
