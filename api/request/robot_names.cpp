#include "api/request/robot_names.h"

#include "api/json/fault_text.h"

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
  const auto found = robots_.find(*name);
  if (found != robots_.end()) return found->second;
  id.fault(fault::kUnknownRobot,
           [&] { return "There is no robot " + in_quotes(*name) + " in " + place_ + "."; });
  return std::nullopt;
}

}  // namespace fleetplan::api
