#pragma once

// What holds for the lower bounds of every plan.

#include <gtest/gtest.h>

#include <algorithm>

#include "core/model/plan.h"

namespace fleetplan::support {

/// Expects that no robot's cost is below its lower bound. The bounds of the plan must be exactly the sum and
/// the maximum of the robots' bounds.
inline void expect_bounded(const core::Plan& plan) {
  core::Objectives total;
  for (const core::RobotPlan& robot : plan.plans) {
    EXPECT_GE(robot.lower_bound, 0.0) << "robot " << robot.robot;
    EXPECT_LE(robot.lower_bound, robot.cost) << "robot " << robot.robot;
    total.flowtime += robot.lower_bound;
    total.makespan = std::max(total.makespan, robot.lower_bound);
  }
  EXPECT_EQ(plan.lower_bound.flowtime, total.flowtime);
  EXPECT_EQ(plan.lower_bound.makespan, total.makespan);
}

}  // namespace fleetplan::support
