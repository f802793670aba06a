#include <fleetplan/verify.h>
#include <gtest/gtest.h>

#include <chrono>
#include <stdexcept>
#include <vector>

#include "tests/library/fleet.h"

namespace fleetplan {
namespace TEST_FILE {

using Kind = Violation::Kind;

/// Straight ahead at 1 m/s.
RobotPlan straight(std::size_t robot, Pose from, Pose to, double seconds) {
  return {robot, seconds, {{Action::Type::translate, 0.0, seconds, from, to, {}, false}}};
}

TEST(PublicVerify, FindsRobotsThatDriveThroughEachOther) {
  Problem problem = corridor_swap();
  problem.robots[1].start.theta = 3.141592653589793;
  const std::vector<RobotPlan> plans{
      straight(0, {0.5, 0.5, 0.0}, {8.5, 0.5, 0.0}, 8.0),
      straight(1, problem.robots[1].start, {0.5, 0.5, 3.141592653589793}, 8.0)};
  const Verification found = verify(problem, plans);
  EXPECT_TRUE(found.finished);
  EXPECT_FALSE(found.valid());
  ASSERT_EQ(found.violations.size(), 1U);
  EXPECT_EQ(found.violations[0].kind, Kind::robot_collision);
  EXPECT_EQ(found.violations[0].robots, (std::vector<std::size_t>{0, 1}));
  EXPECT_NEAR(found.violations[0].t, 4.0, 1e-6);
  EXPECT_NEAR(found.violations[0].required, 0.6, 1e-12);
}

TEST(PublicVerify, FindsSpeedsWallsAndWrongGoals) {
  Problem problem{Map::from_rows({"..#.."}, 1.0), {robot_from({0.5, 0.5, 0.0}, {{4.5, 0.5}})}};
  const auto kind_of_first = [&](const RobotPlan& plan) {
    const Verification found = verify(problem, std::vector{plan});
    return found.violations.empty() ? Kind::zone : found.violations[0].kind;
  };
  EXPECT_EQ(kind_of_first(straight(0, {0.5, 0.5, 0.0}, {4.5, 0.5, 0.0}, 4.0)), Kind::obstacle_collision);
  problem.map = Map(5, 1, 1.0);
  EXPECT_TRUE(verify(problem, std::vector{straight(0, {0.5, 0.5, 0.0}, {4.5, 0.5, 0.0}, 4.0)}).valid());
  EXPECT_EQ(kind_of_first(straight(0, {0.5, 0.5, 0.0}, {4.5, 0.5, 0.0}, 3.0)), Kind::speed);
  EXPECT_EQ(kind_of_first(straight(0, {0.5, 0.5, 0.0}, {4.0, 0.5, 0.0}, 4.0)), Kind::wrong_goal);
}

TEST(PublicVerify, LooksForTheTimeMarginThatIsAskedFor) {
  const Problem problem = corridor_swap();
  const Plan plan = fleetplan::plan(problem);
  Rules rules;
  EXPECT_TRUE(verify(problem, plan.plans, rules).valid());
  rules.interval_margin = 5.0;
  EXPECT_FALSE(verify(problem, plan.plans, rules).valid());
}

TEST(PublicVerify, IsNotValidIfItDoesNotFinish) {
  Rules rules;
  rules.time_budget = std::chrono::nanoseconds(0);
  const Problem problem = corridor_swap();
  const Plan plan = fleetplan::plan(problem);
  const Verification found = verify(problem, plan.plans, rules);
  EXPECT_FALSE(found.finished);
  EXPECT_FALSE(found.valid());
}

TEST(PublicVerify, RefusesPlansThatBelongToNoRobot) {
  const Problem problem = corridor_swap();
  EXPECT_THROW(verify(problem, std::vector{RobotPlan{2}}), std::invalid_argument);
  EXPECT_THROW(verify(problem, std::vector{RobotPlan{0}, RobotPlan{0}}), std::invalid_argument);
}

}  // namespace TEST_FILE
}  // namespace fleetplan
