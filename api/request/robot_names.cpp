#include "api/request/robot_names.h"

#include "api/json/faults.h"

namespace fleetplan::api {

RobotNames::RobotNames(const std::vector<core::Robot>& robots, std::string_view place) : place_(place) {
  for (std::size_t index = 0; index < robots.size(); ++index) robots_.emplace(robots[index].id, index);
}

RobotNames::RobotNames(const std::vector<ReadRobot>& robots, std::string_view place) : place_(place) {
  for (std::size_t index = 0; index < robots.size(); ++index) robots_.emplace(robots[index].robot.id, index);
}

std::optional<std::size_t> RobotNames::find(const JsonReader& id) const {
  const auto name = id.name();
  if (!name) return std::nullopt;
  if (const auto index = index_of(*name)) return index;
  id.fault(fault::kUnknownRobot,
           [&] { return "There is no robot " + in_quotes(*name) + " in " + place_ + "."; });
  return std::nullopt;
}

std::optional<std::size_t> RobotNames::index_of(std::string_view id) const {
  const auto found = robots_.find(std::string(id));
  return found != robots_.end() ? std::optional(found->second) : std::nullopt;
}

}  // namespace fleetplan::api
