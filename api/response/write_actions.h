#pragma once

#include <vector>

#include "api/json/json_writer.h"
#include "api/request/received_robot.h"
#include "core/geometry/position.h"
#include "core/model/action.h"
#include "core/model/robot.h"

namespace fleetplan::api {

/// Writes the member `actions` of a robot. Committed actions, and previous ones that the plan repeats, have
/// the numbers received; what follows begins with the position in which they end. `origin`: of the map in the
/// world.
void write_actions(JsonWriter& json, const std::vector<core::Action>& actions, const core::Robot& robot,
                   const ReceivedRobot& received, const core::Position& origin);

}  // namespace fleetplan::api
