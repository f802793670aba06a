// Plans among zones.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/planner.h"
#include "tests/core/support/planning.h"
#include "tests/support/ascii_map.h"
#include "tests/support/expect_bounds.h"
#include "tests/support/expect_safe.h"
#include "tests/support/problem_builder.h"

namespace fleetplan::core {
namespace {

using support::robot_at;
using testing::HasSubstr;

Zone box(Zone::Type type, const Position& low, const Position& high) {
  Zone zone;
  zone.id = "box";
  zone.type = type;
  zone.polygon = {low, {high.x(), low.y()}, high, {low.x(), high.y()}};
  return zone;
}

Zone blocked_box(const Position& low, const Position& high) { return box(Zone::Type::blocked, low, high); }

Problem with_zones(OccupancyGrid grid, std::vector<Robot> robots, std::vector<Zone> zones) {
  ProblemConditions conditions;
  conditions.zones = std::move(zones);
  return support::make_problem(std::move(grid), std::move(robots), std::move(conditions));
}

/// The plan, after the checker accepted it.
Plan plan_checked(const Problem& problem, const PlanOptions& options = {}) {
  Plan plan = core::plan(problem, options, {});
  support::expect_safe(problem, plan, options);
  support::expect_bounded(plan);
  return plan;
}

double length_of(const RobotPlan& plan) {
  double length = 0.0;
  for (const Action& action : plan.actions) length += (action.to.position - action.from.position).norm();
  return length;
}

TEST(PlannerZones, LeadsAroundABlockedZone) {
  const std::vector<Robot> robots{robot_at(0.5, 5.5).to(10.5, 5.5)};
  const Problem open = support::make_problem(OccupancyGrid(11, 11, 1.0), robots);
  EXPECT_NEAR(length_of(plan_checked(open).plans.at(0)), 10.0, 1e-9);
  const Problem blocked = with_zones(OccupancyGrid(11, 11, 1.0), robots, {blocked_box({4, 3}, {7, 9})});
  const double length = length_of(plan_checked(blocked).plans.at(0));
  EXPECT_GT(length, 10.5);
  EXPECT_LT(length, 12.5);
}

TEST(PlannerZones, AZoneBlocksOnlyItsRobots) {
  const std::vector<Robot> robots{robot_at(0.5, 2.5).to(10.5, 2.5), robot_at(0.5, 7.5).to(10.5, 7.5)};
  Zone wall = blocked_box({5, 1}, {6, 10});
  wall.robots = {1};
  const Plan plan = plan_checked(with_zones(OccupancyGrid(11, 11, 1.0), robots, {wall}));
  ASSERT_EQ(plan.plans.size(), 2U);
  EXPECT_NEAR(length_of(plan.plans[0]), 10.0, 1e-9);
  EXPECT_GT(length_of(plan.plans[1]), 11.0);
}

TEST(PlannerZones, PassesAGapBetweenZonesThatIsOffTheLattice) {
  const std::vector<Robot> robots{robot_at(0.5, 2.5).to(9.5, 2.5)};
  // The gap of 0.9 m lies around y = 5, between the centres of the cells.
  const std::vector<Zone> zones{blocked_box({4, -1}, {6, 4.55}), blocked_box({4, 5.45}, {6, 12})};
  const Plan plan = plan_checked(with_zones(OccupancyGrid(10, 10, 1.0), robots, zones));
  EXPECT_TRUE(plan.unplanned.empty());
}

TEST(PlannerZones, KeepsTheInflatedDiskOutOfAZone) {
  const std::vector<Robot> robots{robot_at(1.5, 5.5).to(9.5, 5.5)};
  const Problem problem = with_zones(OccupancyGrid(11, 11, 1.0), robots, {blocked_box({4, 3}, {7, 9})});
  PlanOptions options;
  options.inflation = 0.3;
  const Plan plan = plan_checked(problem, options);
  ASSERT_EQ(plan.plans.size(), 1U);
  CheckRules inflated;
  inflated.inflation = options.inflation;
  EXPECT_TRUE(support::safety_report(problem, plan.plans, inflated).valid());
  inflated.inflation = 1.0;
  EXPECT_FALSE(support::safety_report(problem, plan.plans, inflated).valid());
}

TEST(PlannerZones, AZoneAcrossTheMapLeavesNoWay) {
  const std::vector<Robot> robots{robot_at(0.5, 5.5).to(10.5, 5.5)};
  const Problem problem = with_zones(OccupancyGrid(11, 11, 1.0), robots, {blocked_box({5, -1}, {6, 12})});
  const Plan plan = plan_checked(problem);
  ASSERT_EQ(plan.unplanned.size(), 1U);
  EXPECT_EQ(plan.unplanned[0].reason, Unplanned::Reason::goal_unreachable);
}

TEST(ProblemFaults, NameTheBlockedZone) {
  const auto faults_of = [](const Robot& robot, Zone zone) {
    ProblemConditions conditions;
    conditions.zones = {std::move(zone)};
    auto made = Problem::create(OccupancyGrid(11, 11, 1.0), {robot}, std::move(conditions), {});
    return std::get<ProblemFaults>(made).listed;
  };
  const auto start = faults_of(robot_at(3.8, 5.5).to(10.5, 5.5), blocked_box({4, 3}, {7, 9}));
  ASSERT_EQ(start.size(), 1U);
  EXPECT_EQ(start[0].kind, ProblemFault::Kind::start_in_obstacle);
  EXPECT_EQ(start[0].zone, 0U);
  EXPECT_NEAR(start[0].gap, -0.2, 1e-12);
  const auto goal = faults_of(robot_at(0.5, 5.5).to(5.5, 5.5), blocked_box({4, 3}, {7, 9}));
  ASSERT_EQ(goal.size(), 1U);
  EXPECT_EQ(goal[0].kind, ProblemFault::Kind::goal_in_obstacle);
  EXPECT_EQ(goal[0].zone, 0U);
  const auto committed =
      faults_of(robot_at(0.5, 5.5).drives(5.5, 5.5).to(10.5, 5.5), blocked_box({4, 3}, {7, 9}));
  ASSERT_EQ(committed.size(), 1U);
  EXPECT_EQ(committed[0].kind, ProblemFault::Kind::committed_collision);
  EXPECT_EQ(committed[0].zone, 0U);
  EXPECT_NEAR(committed[0].t, 3.1, 1e-6);
}

}  // namespace
}  // namespace fleetplan::core
