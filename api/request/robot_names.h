#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "api/json/json_reader.h"
#include "api/request/parse_robots.h"
#include "core/model/robot.h"

namespace fleetplan::api {

/// The robots of a request by their ids.
class RobotNames {
 public:
  /// `place`: where a request lists them, for messages.
  explicit RobotNames(const std::vector<core::Robot>& robots, std::string_view place = "robots");
  explicit RobotNames(const std::vector<ReadRobot>& robots, std::string_view place = "robots");

  /// The index of the robot whose id the value is. Anything else is a fault.
  std::optional<std::size_t> find(const JsonReader& id) const;
  /// The index of the robot of this id, if there is one.
  std::optional<std::size_t> index_of(std::string_view id) const;

 private:
  std::string place_;
  std::unordered_map<std::string, std::size_t> robots_;
};

}  // namespace fleetplan::api
