#pragma once

#include <fleetplan/action.h>

#include <cstddef>
#include <string>
#include <vector>

#include "core/model/action.h"
#include "core/model/robot.h"
#include "library/convert.h"
#include "library/ranges.h"

namespace fleetplan::library {

/// Reads the committed or previous actions of a robot. Differences within the contact tolerance are removed,
/// so that the actions are exactly contiguous; larger ones, and actions that the robot cannot execute, are
/// faults. The first `measured` actions may be measured motion, which has no profiles.
std::vector<core::Action> read_actions(const std::vector<Action>& actions, const core::Robot& robot,
                                       std::size_t measured, const Frame& frame, const std::string& place,
                                       FaultList& faults);

}  // namespace fleetplan::library
