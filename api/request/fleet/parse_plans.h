#pragma once

// The plans of a request, and what belongs to them:
//
// - dependencies,
// - unavoidable collisions, which the check exempts,
// - and robots that an answer calls invalid.

#include <vector>

#include "api/json/json_reader.h"
#include "api/request/fleet/parse_robots.h"
#include "api/request/shared_members.h"
#include "core/execution/dependencies.h"
#include "core/model/plan.h"
#include "core/model/robot.h"

namespace fleetplan::api {

struct Fleet;

/// Reads the member `plans` of a request to validate: at most one plan for each robot, in any order. The
/// checker decides later whether the plans are valid.
///
/// Open goals get the poses that the visits of the plans name. Otherwise, they get the poses at which the
/// actions serve them first. These are the actions of the plan, or the committed actions if there is no plan.
std::vector<core::RobotPlan> parse_plans(const JsonReader& member, std::vector<ParsedRobot>& robots,
                                         const WorldFrame& frame);

/// Reports profiles of plans that do not cover their actions in their times. `list`: the member that the
/// plans come from, in their order.
void check_profiles(const JsonReader& list, const std::vector<core::RobotPlan>& plans);

/// Reads `dependencies`, which the service has made for these plans. Robots and actions that do not exist,
/// and times that contradict the plans, are faults. Robots that obey dependencies without a fault never wait
/// for ever, because every `until` is planned before its `gate`.
std::vector<core::Dependency> parse_dependencies(const JsonReader& member,
                                                 const std::vector<core::Robot>& robots,
                                                 const std::vector<core::RobotPlan>& plans);

/// Reads `unavoidable` of a request to validate (may be absent): the collisions that the check exempts.
std::vector<core::UnavoidableCollision> parse_unavoidable(const JsonReader& member, const Fleet& fleet);

/// Marks the robots as invalid that `unplanned` of an answer lists as invalid. Other contents are ignored.
void mark_invalid_robots(const JsonReader& unplanned, std::vector<core::Robot>& robots);

}  // namespace fleetplan::api
