#include "api/request/parse_request.h"

#include <array>
#include <optional>
#include <utility>

#include "api/request/make_problem.h"
#include "api/request/parse_body.h"

namespace fleetplan::api {

namespace {

constexpr std::array<std::string_view, 4> kMembers{"map", "robot_defaults", "robots", "options"};

}  // namespace

Result<PlanRequest, RequestError> parse_request(std::string_view body, const Limits& limits,
                                                const ParseStop& stop) {
  const auto parse = [&](const JsonReader& root, ParseStop& reading) -> std::optional<PlanRequest> {
    Fleet fleet = parse_fleet(root, limits, [&](const ReadOptions& options) {
      reading.set_budget(effective_budget(options, limits));
    });
    if (!fleet.map || reading.met()) return std::nullopt;
    auto problem = make_problem(std::move(fleet.map->grid), fleet.robots, root, reading);
    if (!problem) return std::nullopt;
    std::vector<std::string> warnings = std::move(fleet.options.warnings);
    if (auto warning = budget_warning(fleet.options, limits)) warnings.push_back(std::move(*warning));
    return PlanRequest{std::move(*problem), fleet.options.plan, effective_budget(fleet.options, limits),
                       fleet.map->frame, std::move(warnings)};
  };
  return parse_body<PlanRequest>(body, limits, stop, kMembers, parse);
}

}  // namespace fleetplan::api
