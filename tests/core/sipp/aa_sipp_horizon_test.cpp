// Where the search for one robot ends with a horizon.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "core/sipp/aa_sipp.h"
#include "tests/core/support/planning.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::robot_at;

PlanOptions up_to(double horizon) {
  PlanOptions options;
  options.horizon = horizon;
  return options;
}

OccupancyGrid corridor() { return support::ascii_map({"...................."}); }

/// A trajectory may stop at the horizon, which takes the place of its cost.
void expect_safe_up_to_horizon(const Planning& p) {
  std::vector<RobotPlan> plans = support::plans_of(p.reservations);
  for (RobotPlan& plan : plans)
    plan.cost = p.reservations.trajectory(plan.robot)->stops_at.value_or(plan.cost);
  CheckRules rules;
  rules.horizon = p.instance.options().horizon;
  const VerifyReport report = support::safety_report(p.problem, plans, rules);
  EXPECT_TRUE(report.valid()) << support::text(report);
}

Trajectory plan_of(Planning& p, std::size_t robot) {
  const SearchResult result = p.state.plan(robot, kExact, p.never);
  EXPECT_TRUE(result.trajectory);
  if (!result.trajectory) return {};
  p.reservations.follow(robot, *result.trajectory);
  expect_safe_up_to_horizon(p);
  return *result.trajectory;
}

TEST(AaSippHorizon, EndsAtTheGoalIfThatIsNearer) {
  Planning p(corridor(), {robot_at(0.5, 0.5).to(6.5, 0.5)}, up_to(10.0));
  const Trajectory trajectory = plan_of(p, 0);
  EXPECT_FALSE(trajectory.stops_at);
  EXPECT_NEAR(trajectory.cost, 6.0, 1e-9);
}

TEST(AaSippHorizon, EndsWhereTheRobotMayRestFromTheHorizonOn) {
  Planning p(corridor(), {robot_at(0.5, 0.5).to(18.5, 0.5)}, up_to(4.5));
  const Trajectory trajectory = plan_of(p, 0);
  ASSERT_TRUE(trajectory.stops_at);
  EXPECT_NEAR(*trajectory.stops_at, 5.0, 1e-9) << "the first vertex from the horizon on";
  EXPECT_NEAR(trajectory.end().x(), 5.5, 1e-9);
  EXPECT_NEAR(trajectory.cost, 18.0, 1e-9) << "the rest of its way included";
}

TEST(AaSippHorizon, WaitsUntilTheHorizonBehindARobotThatStays) {
  Planning p(corridor(), {robot_at(0.5, 0.5).to(18.5, 0.5), robot_at(3.5, 0.5)}, up_to(8.0));
  p.reservations.stay_in_place(1);
  const Trajectory trajectory = plan_of(p, 0);
  ASSERT_TRUE(trajectory.stops_at);
  EXPECT_NEAR(*trajectory.stops_at, 8.0, 1e-9);
  EXPECT_NEAR(trajectory.end().x(), 2.5, 1e-9) << "as near as it can";
  EXPECT_NEAR(trajectory.cost, 8.0 + 16.0, 1e-9);
}

TEST(AaSippHorizon, DoesNotRestWhereAnotherRobotPassesLater) {
  Planning p(support::ascii_map({"..........", "..........", ".........."}),
             {robot_at(0.5, 1.5).to(9.5, 1.5), robot_at(9.5, 1.5, std::numbers::pi).to(0.5, 1.5)},
             up_to(3.0));
  p.reservations.follow(1, through({{9.5, 1.5}, {0.5, 1.5}}));
  const Trajectory trajectory = plan_of(p, 0);
  ASSERT_TRUE(trajectory.stops_at);
  EXPECT_GE(std::abs(trajectory.end().y() - 1.5), 0.5) << "beside the other's way";
}

TEST(AaSippHorizon, GoesOnTowardsAGoalWhereAnotherRobotRests) {
  Planning p(corridor(), {robot_at(0.5, 0.5).to(9.5, 0.5), robot_at(9.5, 0.5).to(15.5, 0.5)}, up_to(20.0));
  p.reservations.stay_in_place(1);
  const Trajectory trajectory = plan_of(p, 0);
  ASSERT_TRUE(trajectory.stops_at);
  EXPECT_NEAR(trajectory.end().x(), 8.5, 1e-9);
  EXPECT_NEAR(*trajectory.stops_at, 20.0, 1e-9);
}

TEST(AaSippHorizon, LeavesGoalsBehindTheHorizonForLater) {
  Robot robot = robot_at(0.5, 0.5).to(18.5, 0.5);
  robot.via = {Goal{Position(2.5, 0.5), std::nullopt, 1.0}, Goal{Position(15.5, 0.5), std::nullopt, 2.0}};
  Planning p(corridor(), {robot}, up_to(6.0));
  const Trajectory trajectory = plan_of(p, 0);
  ASSERT_TRUE(trajectory.stops_at);
  ASSERT_EQ(trajectory.visits.size(), 1u);
  EXPECT_NEAR(trajectory.visits[0].t_leave, 3.0, 1e-9);
  EXPECT_NEAR(trajectory.end().x(), 5.5, 1e-9);
  EXPECT_NEAR(trajectory.cost, 18.0 + 3.0, 1e-9) << "with the service that is left";
}

TEST(AaSippHorizon, EndsWhereTheCommitmentDoesIfThatIsLater) {
  Robot robot = robot_at(0.5, 0.5).to(18.5, 0.5);
  robot.committed = {{Action::Type::translate, 0.0, 7.0, {{0.5, 0.5}, 0.0}, {{7.5, 0.5}, 0.0}, {}}};
  Planning p(corridor(), {robot}, up_to(3.0));
  const Trajectory trajectory = plan_of(p, 0);
  ASSERT_TRUE(trajectory.stops_at);
  EXPECT_NEAR(*trajectory.stops_at, 7.0, 1e-9);
  EXPECT_EQ(trajectory.moves.size(), 1u);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
