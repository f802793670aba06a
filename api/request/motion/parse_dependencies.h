#pragma once

#include <vector>

#include "api/json/json_reader.h"
#include "core/execution/dependency.h"
#include "core/model/plan.h"
#include "core/model/robot.h"

namespace fleetplan::api {

/// Reads `dependencies`: those that the service has made for these plans. Robots and actions that do not
/// exist, and times that contradict the plans, are faults. Whoever obeys dependencies without a fault never
/// waits for ever, because every `until` is planned before its `gate`.
std::vector<core::Dependency> parse_dependencies(const JsonReader& member,
                                                 const std::vector<core::Robot>& robots,
                                                 const std::vector<core::RobotPlan>& plans);

}  // namespace fleetplan::api
