#include "core/execution/executed_actions.h"

#include <gtest/gtest.h>

#include "tests/support/plan_builder.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::PlanBuilder;

/// A robot that waits for 6 s before it drives, with a goal where it waits.
class WaitPurposes : public testing::Test {
 protected:
  WaitPurpose purpose(double added) const { return wait_purposes(robot_, plan_.actions, added).front(); }

  void serve(double service, double not_before) {
    robot_.via = {Goal{{0, 0}, {}, service, not_before}};
    plan_.actions.front().goal = 0;
  }

  Robot robot_{"a", 0.5, 1.0, 2.0, {}, Goal{{5, 0}, {}}};
  RobotPlan plan_ = PlanBuilder(0, robot_).wait(6.0).translate_to(5, 0).build();
};

TEST_F(WaitPurposes, OfAWaitThatGivesWayIsNothing) {
  EXPECT_EQ(purpose(0.0).least, 0.0);
  EXPECT_EQ(purpose(0.0).not_before, 0.0);
}

TEST_F(WaitPurposes, OfAnAddedWaitIsItsDurationAsFarAsPlanned) {
  EXPECT_EQ(purpose(2.5).least, 2.5);
  EXPECT_EQ(purpose(2.5).not_before, 0.0);
  EXPECT_EQ(purpose(7.0).least, 6.0);
  EXPECT_EQ(wait_purposes(robot_, plan_.actions, 2.5)[1].least, 0.0);
}

TEST_F(WaitPurposes, OfAServiceIsItsDurationFromWhenItMayBegin) {
  serve(1.0, 4.0);
  EXPECT_EQ(purpose(0.5).least, 1.0);
  EXPECT_EQ(purpose(0.5).not_before, 4.0);
}

TEST_F(WaitPurposes, OfAServiceAtTheEndOfALongerAddedWaitEndWhenPlanned) {
  serve(1.0, 5.0);
  EXPECT_EQ(purpose(2.5).least, 2.5);
  EXPECT_EQ(purpose(2.5).not_before, 3.5);
  serve(1.0, 0.0);
  EXPECT_EQ(purpose(2.5).not_before, 0.0);
}

TEST_F(WaitPurposes, IgnoreAGoalThatTheRobotDoesNotHave) {
  plan_.actions.front().goal = 1;
  EXPECT_EQ(purpose(0.0).least, 0.0);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
