#pragma once

// A robot whose radius changes is one disk after the other.

#include <vector>

#include "core/model/plan.h"
#include "core/model/robot.h"
#include "core/verify/execution/execution.h"
#include "core/verify/tolerances.h"

namespace fleetplan::core {

/// A disk of constant radius on its way.
struct Body {
  double radius = 0.0;  // metres
  std::vector<Leg> legs;
};

/// The disks of a robot, each from the end of the one before, the first from t = 0, the last to infinity.
/// `legs` are a result of `execute` for the same plan (null: none, the robot executes its commitment).
///
/// The radius changes at the end of the service at a goal with `radius_after`. Each goal is served as early
/// as possible, by an uninterrupted rest in its pose after the goals before it. The last one is served by the
/// rest at the end of the plan, after the commitment; a robot without a plan does not serve it. One that
/// has neither a plan nor a commitment serves none.
std::vector<Body> bodies_of(const Robot& robot, const RobotPlan* plan, std::vector<Leg> legs,
                            const Tolerance& tolerance);

}  // namespace fleetplan::core
