#include "api/request/parse_request.h"

#include <algorithm>
#include <array>
#include <utility>

#include "api/json/text.h"
#include "api/request/make_problem.h"

namespace fleetplan::api {

namespace {

constexpr std::array<std::string_view, 4> kMembers{"map", "robot_defaults", "robots", "options"};

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
