#pragma once

#include <optional>

#include "core/model/plan.h"
#include "core/model/robot.h"
#include "core/verify/tolerances.h"
#include "core/verify/verify.h"

namespace fleetplan::core {

/// Reports a plan that does not begin with the committed actions (`committed_changed`), once: the first
/// number that differs, at all if `exact`, otherwise by more than the tolerance.
std::optional<Violation> check_commitments(const Robot& robot, const RobotPlan& plan,
                                           const Tolerance& tolerance, bool exact);

}  // namespace fleetplan::core
