#pragma once

// What holds for the lower bounds of every plan that is told.

#include <gtest/gtest.h>

#include <algorithm>

#include "core/model/plan.h"

namespace fleetplan::support {

/// No robot costs less than its bound, and the plan's bounds are made of theirs, to the last bit.
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
