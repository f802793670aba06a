#include "api/request/parse_request.h"

#include <array>
#include <optional>
#include <utility>

#include "api/request/make_problem.h"
#include "api/request/parse_body.h"

namespace fleetplan::api {

namespace {

constexpr std::array<std::string_view, 7> kPlanRequestMembers{
    "map", "robot_defaults", "robots", "obstacles", "zones", "options", "metadata"};

/// `errors`: of each robot, or none.
std::vector<ReceivedRobot> received(std::vector<ReadRobot>& robots, std::vector<std::vector<Fault>> errors) {
  std::vector<ReceivedRobot> received(robots.size());
  for (std::size_t index = 0; index < robots.size(); ++index) {
    ReadRobot& read = robots[index];
    received[index] = {std::move(read.received_committed),
                       std::move(read.received_previous),
                       read.lists_visits,
                       errors.empty() ? std::vector<Fault>{} : std::move(errors[index]),
                       std::move(read.metadata),
                       std::move(read.goal_metadata)};
  }
  return received;
}

}  // namespace

Result<PlanRequest, RequestError> parse_request(std::string_view body, const Limits& limits, core::Work& stop,
                                                core::MapCache* maps) {
  const auto parse = [&](const JsonReader& root, core::Work& reading) -> std::optional<PlanRequest> {
    Fleet fleet = parse_fleet(root, limits, [&](const ReadOptions& options) {
      reading.set_budget(effective_budget(options, limits));
    });
    if (!fleet.map || reading.met()) return std::nullopt;
    auto made = make_problem(fleet, root, reading, maps);
    if (!made) return std::nullopt;
    std::vector<std::string> warnings = std::move(fleet.options.warnings);
    if (auto warning = budget_warning(fleet.options, limits)) warnings.push_back(std::move(*warning));
    return PlanRequest{std::move(made->problem),
                       fleet.options.plan,
                       effective_budget(fleet.options, limits),
                       fleet.map->frame,
                       std::move(warnings),
                       received(fleet.robots, std::move(made->errors)),
                       std::move(fleet.metadata),
                       requested_dependencies(fleet)};
  };
  return parse_body<PlanRequest>(body, limits, stop, kPlanRequestMembers, parse);
}

}  // namespace fleetplan::api
