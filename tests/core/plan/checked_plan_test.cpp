#include "core/plan/checked_plan.h"

#include <gtest/gtest.h>

#include "core/plan/planner.h"
#include "core/runtime/stop_condition.h"
#include "tests/support/problem_builder.h"
#include "tests/support/step_limit.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::robot_at;

/// Two robots cross, one stands, and one is committed to drive a metre.
Problem crossing() {
  return support::make_problem(OccupancyGrid(12, 12, 1.0),
                               {robot_at(1.5, 5.5).to(9.5, 5.5), robot_at(5.5, 1.5).to(5.5, 9.5),
                                robot_at(10.5, 1.5), robot_at(1.5, 10.5).drives(2.5, 10.5)});
}

StopCondition never() { return StopCondition::never(); }

TEST(CheckedPlan, IsTheWholePlanIfThereIsTime) {
  const Problem problem = crossing();
  const Plan plan = core::plan(problem, {}, never());
  ASSERT_TRUE(plan.unplanned.empty());
  const CheckOfPlan checked = check(plan, problem, {}, never(), never);
  ASSERT_TRUE(checked.report);
  EXPECT_TRUE(checked.report->valid());
  EXPECT_EQ(&checked.checked(plan), &plan);
}

TEST(CheckedPlan, LetsRobotsStayIfTheirPlanCouldNotBeChecked) {
  const Problem problem = crossing();
  const Plan plan = core::plan(problem, {}, never());
  support::StepLimit limit(0);
  const CheckOfPlan checked = check(plan, problem, {}, support::counted(limit), never);
  ASSERT_TRUE(checked.report);
  EXPECT_TRUE(checked.report->valid());
  const Plan& left = checked.checked(plan);
  EXPECT_FALSE(left.deterministic);
  ASSERT_EQ(left.unplanned.size(), 2U);
  EXPECT_EQ(left.unplanned[0].robot, 0U);
  EXPECT_EQ(left.unplanned[1].robot, 1U);
  EXPECT_EQ(left.unplanned[0].reason, Unplanned::Reason::budget_exhausted);
  for (const RobotPlan& robot : left.plans) {
    EXPECT_EQ(robot.actions.size(), problem.robots()[robot.robot].committed.size());
  }
}

TEST(CheckedPlan, HasNoReportIfNothingCouldBeChecked) {
  const Problem problem = crossing();
  support::StepLimit limit(0);
  const StopCondition at_once = support::counted(limit);
  EXPECT_FALSE(check(core::plan(problem, {}, never()), problem, {}, at_once, [&] { return at_once; }).report);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
