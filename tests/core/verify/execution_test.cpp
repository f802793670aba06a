// Positions over time, for valid and invalid plans.

#include "core/verify/execution.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/verify/pairs/fleet_clearance.h"
#include "tests/core/verify/scene.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::PlanBuilder;

/// Expects contiguous legs from t = 0 to infinity.
void expect_all_of_time(const std::vector<Leg>& legs) {
  EXPECT_EQ(legs.front().t_begin, 0.0);
  EXPECT_TRUE(std::isinf(legs.back().t_end));
  for (std::size_t k = 1; k < legs.size(); ++k) EXPECT_EQ(legs[k].t_begin, legs[k - 1].t_end);
  for (const Leg& leg : legs) EXPECT_LE(leg.t_begin, leg.t_end);
}

Position position_of(const std::vector<Leg>& legs, double t) {
  for (const Leg& leg : legs) {
    if (t < leg.t_end) return position_at(leg, t);
  }
  return legs.back().to;
}

TEST(Execution, KeepsARobotWithoutAPlanAtItsStart) {
  const auto legs = execute(robot_at(2, 3), nullptr);
  ASSERT_EQ(legs.size(), 1U);
  expect_all_of_time(legs);
  EXPECT_EQ(position_at(legs[0], 1e9), Position(2, 3));
}

TEST(Execution, InterpolatesActionsAndKeepsTheLastPose) {
  const Robot robot = robot_at(2, 3);
  const RobotPlan plan = PlanBuilder(0, robot).wait(1).translate_to(6, 3).build();
  const auto legs = execute(robot, &plan);
  expect_all_of_time(legs);
  EXPECT_EQ(position_of(legs, 0.5), Position(2, 3));
  EXPECT_EQ(position_of(legs, 2.0), Position(3, 3));
  EXPECT_EQ(position_of(legs, 100.0), Position(6, 3));
}

TEST(Execution, WaitsInAGap) {
  const Robot robot = robot_at(2, 3);
  RobotPlan plan = PlanBuilder(0, robot).translate_to(3, 3).translate_to(4, 3).build();
  plan.actions[0].t_start = 5.0;
  plan.actions[0].t_end = 6.0;
  plan.actions[1].t_start = 8.0;
  plan.actions[1].t_end = 9.0;
  const auto legs = execute(robot, &plan);
  expect_all_of_time(legs);
  EXPECT_EQ(position_of(legs, 4.0), Position(2, 3));
  EXPECT_EQ(position_of(legs, 7.0), Position(3, 3));
  EXPECT_EQ(position_of(legs, 8.5), Position(3.5, 3));
}

TEST(Execution, SkipsThePartOfAnActionBeforeThePreviousEnd) {
  const Robot robot = robot_at(2, 3);
  RobotPlan plan = PlanBuilder(0, robot).translate_to(4, 3).translate_to(8, 3).build();
  plan.actions[1].t_start = 1.0;  // a second too early
  plan.actions[1].t_end = 5.0;
  const auto legs = execute(robot, &plan);
  expect_all_of_time(legs);
  EXPECT_EQ(position_of(legs, 2.0), Position(5, 3));
  plan.actions[0].t_start = -2.0;
  plan.actions[0].t_end = -1.0;
  plan.actions[1].t_end = -3.0;
  expect_all_of_time(execute(robot, &plan));
  EXPECT_EQ(position_of(execute(robot, &plan), 2.0), Position(8, 3));
}

TEST(TimeWindows, HaveOneBoundaryWithoutMotion) {
  EXPECT_EQ(time_windows({execute(robot_at(1, 1), nullptr)}), std::vector<double>{0.0});
}

TEST(TimeWindows, AscendFromZeroToTheEndDespiteOneSlowRobot) {
  const Robot robot = robot_at(1, 1);
  const RobotPlan quick = PlanBuilder(0, robot).wait(1).wait(0).wait(1).wait(1).build();
  const RobotPlan slow = PlanBuilder(0, robot).wait(1e9).build();
  const auto windows = time_windows({execute(robot, &quick), execute(robot, &slow)});
  EXPECT_EQ(windows.front(), 0.0);
  EXPECT_EQ(windows.back(), 1e9);
  for (std::size_t k = 1; k < windows.size(); ++k) EXPECT_LT(windows[k - 1], windows[k]);
  EXPECT_GE(std::count_if(windows.begin(), windows.end(), [](double t) { return t <= 3.0; }), 10);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
