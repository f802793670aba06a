#pragma once

// Checks of plans by the independent checker.

#include <gtest/gtest.h>

#include <cstddef>
#include <utility>
#include <vector>

#include "core/actions.h"
#include "core/model/plan.h"
#include "core/model/problem.h"
#include "core/prioritized/plan_state.h"
#include "core/verify/verify.h"
#include "tests/support/summary.h"

namespace fleetplan::support {

/// Metres: the contact tolerance of the service, and the rounding of times and positions.
inline constexpr double kSafeTolerance = 2e-9;

/// Expects that planned robots collide with no other robot, planned or not, and not with the map.
inline void expect_safe(const core::Problem& problem, const std::vector<core::RobotPlan>& plans) {
  const core::VerifyReport report = core::verify(problem.grid(), problem.robots(), plans, kSafeTolerance);
  EXPECT_TRUE(report.valid()) << text(report);
}

/// Expects this also with radii enlarged by `inflation`, except those of robots whose start is blocked.
inline void expect_safe(const core::Problem& problem, const core::Plan& plan, double inflation = 0.0) {
  expect_safe(problem, plan.plans);
  if (inflation == 0.0) return;
  std::vector<core::Robot> robots = problem.robots();
  for (core::Robot& robot : robots) robot.radius += inflation;
  for (const core::Unplanned& robot : plan.unplanned) {
    if (robot.reason == core::Unplanned::Reason::start_blocked) robots[robot.robot].radius -= inflation;
  }
  const core::VerifyReport report = core::verify(problem.grid(), robots, plan.plans, kSafeTolerance);
  EXPECT_TRUE(report.valid()) << "inflated by " << inflation << ": " << text(report);
}

/// The current trajectories as plans. Robots without a trajectory have none.
inline std::vector<core::RobotPlan> plans_of(const core::PlanState& state) {
  std::vector<core::RobotPlan> plans;
  for (std::size_t i = 0; i < state.instance().size(); ++i) {
    const auto& trajectory = state.trajectory(i);
    if (!trajectory) continue;
    plans.push_back({i, trajectory->cost, core::to_actions(state.instance().robot(i), *trajectory)});
  }
  return plans;
}

inline void expect_safe(const core::PlanState& state) {
  expect_safe(state.instance().problem(), plans_of(state));
}

}  // namespace fleetplan::support
