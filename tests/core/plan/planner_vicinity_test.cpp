// Plans of robots that keep a distance from each other.

#include <gtest/gtest.h>

#include "tests/support/ascii_map.h"
#include "tests/support/expect_safe.h"
#include "tests/support/plan_checked.h"
#include "tests/support/problem_builder.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::plan_checked;
using support::robot_at;

std::vector<Robot> with_vicinity(std::vector<Robot> robots, double vicinity) {
  for (Robot& robot : robots) robot.vicinity = vicinity;
  return robots;
}

VerifyReport report_of(const Problem& problem, const Plan& plan) {
  return support::safety_report(problem, plan.plans);
}

TEST(PlannerVicinity, RobotsPassEachOtherAtTheDistance) {
  const std::vector<Robot> robots{robot_at(0.5, 3.5).to(9.5, 3.5), robot_at(9.5, 3.5).to(0.5, 3.5)};
  const Problem apart = support::make_problem(OccupancyGrid(10, 7, 1.0), with_vicinity(robots, 0.4));
  const Plan plan = plan_checked(apart);
  ASSERT_TRUE(plan.unplanned.empty());
  EXPECT_GE(*report_of(apart, plan).min_clearance, 0.8 - 1e-6);
  const Problem near = support::make_problem(OccupancyGrid(10, 7, 1.0), robots);
  EXPECT_LT(*report_of(near, plan_checked(near)).min_clearance, 0.8);
}

TEST(PlannerVicinity, DoesNotKeepFromWalls) {
  const OccupancyGrid corridor = support::ascii_map({"##########",  //
                                                     "..........",  //
                                                     "##########"});
  std::vector<Robot> robots = with_vicinity({robot_at(0.5, 1.5).to(9.5, 1.5)}, 0.5);
  const Problem problem = support::make_problem(corridor, robots);
  EXPECT_TRUE(plan_checked(problem).unplanned.empty());
  PlanOptions inflated;
  inflated.inflation = 0.5;
  EXPECT_EQ(plan_checked(problem, inflated).unplanned.size(), 1u);
}

TEST(PlannerVicinity, AParkedRobotBlocksAWayThatIsTooNarrow) {
  const OccupancyGrid hall(9, 3, 1.0);
  std::vector<Robot> robots{robot_at(0.5, 0.5).to(8.5, 0.5), robot_at(4.5, 2.5)};
  EXPECT_TRUE(plan_checked(support::make_problem(hall, robots)).unplanned.empty());
  const Plan plan = plan_checked(support::make_problem(hall, with_vicinity(robots, 0.7)));
  ASSERT_EQ(plan.unplanned.size(), 1u);
  EXPECT_EQ(plan.unplanned[0].blocked_by, (std::vector<std::size_t>{1}));
}

TEST(PlannerVicinity, RobotsThatStandWithinItLeave) {
  const std::vector<Robot> robots = with_vicinity(
      {robot_at(3.5, 3.5).to(0.5, 3.5), robot_at(4.5, 3.5).to(9.5, 3.5), robot_at(4.0, 4.5).to(4.5, 6.5)},
      0.6);
  const Plan plan = plan_checked(support::make_problem(OccupancyGrid(10, 8, 1.0), robots));
  EXPECT_TRUE(plan.unplanned.empty());
}

TEST(PlannerVicinity, GoalsWithinItAreNotReachedByBoth) {
  const std::vector<Robot> robots =
      with_vicinity({robot_at(0.5, 3.5).to(4.5, 3.5), robot_at(9.5, 3.5).to(5.5, 3.5)}, 0.3);
  const Plan plan = plan_checked(support::make_problem(OccupancyGrid(10, 7, 1.0), robots));
  EXPECT_EQ(plan.plans.size(), 1u);
  EXPECT_EQ(plan.unplanned.size(), 1u);
}

TEST(PlannerVicinity, OfOneRobotKeepsCommittedMotionAtTheDistance) {
  std::vector<Robot> robots{robot_at(0.5, 3.5).drives(9.5, 3.5).to(9.5, 3.5),
                            robot_at(5.5, 0.5).to(5.5, 6.5)};
  robots[1].vicinity = 1.0;
  const Plan plan = plan_checked(support::make_problem(OccupancyGrid(10, 7, 1.0), robots));
  EXPECT_TRUE(plan.unplanned.empty());
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
