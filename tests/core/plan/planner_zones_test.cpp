// Plans among zones.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/ascii_map.h"
#include "tests/support/expect_safe.h"
#include "tests/support/plan_checked.h"
#include "tests/support/problem_builder.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::box;
using support::plan_checked;
using support::robot_at;
using testing::HasSubstr;

Zone blocked_box(const Position& low, const Position& high) { return box(Zone::Type::blocked, low, high); }

Problem with_zones(OccupancyGrid grid, std::vector<Robot> robots, std::vector<Zone> zones) {
  ProblemConditions conditions;
  conditions.zones = std::move(zones);
  return support::make_problem(std::move(grid), std::move(robots), std::move(conditions));
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

Zone one_way_box(const Position& low, const Position& high, double heading, double half_angle = 1.5) {
  Zone zone = box(Zone::Type::one_way, low, high);
  zone.heading = heading;
  zone.half_angle = half_angle;
  return zone;
}

Zone slow_box(const Position& low, const Position& high, double linear, double angular = Zone::kNoLimit) {
  Zone zone = box(Zone::Type::speed, low, high);
  zone.linear_speed = linear;
  zone.angular_speed = angular;
  return zone;
}

TEST(PlannerZones, DrivesWithAOneWayZoneAndAroundItOtherwise) {
  const Zone east = one_way_box({3, 3}, {8, 8}, 0.0);
  const Problem with = with_zones(OccupancyGrid(11, 11, 1.0), {robot_at(0.5, 5.5).to(10.5, 5.5)}, {east});
  EXPECT_NEAR(length_of(plan_checked(with).plans.at(0)), 10.0, 1e-9);
  const Problem against = with_zones(OccupancyGrid(11, 11, 1.0), {robot_at(10.5, 5.5).to(0.5, 5.5)}, {east});
  const double length = length_of(plan_checked(against).plans.at(0));
  EXPECT_GT(length, 10.5);  // along the border
  EXPECT_LT(length, 13.0);
}

TEST(PlannerZones, ReversingIsNoWayAgainstAOneWayZone) {
  Robot robot = robot_at(10.5, 5.5).to(0.5, 5.5);
  robot.may_reverse = true;
  const Problem problem =
      with_zones(OccupancyGrid(11, 11, 1.0), {robot}, {one_way_box({3, -1}, {8, 12}, 0.0)});
  const Plan plan = plan_checked(problem);
  ASSERT_EQ(plan.unplanned.size(), 1U);
  EXPECT_EQ(plan.unplanned[0].reason, Unplanned::Reason::goal_unreachable);
}

TEST(PlannerZones, OneWayCorridorsMakeRobotsGoRound) {
  const OccupancyGrid ring = support::ascii_map({"...........",  //
                                                 ".#########.",  //
                                                 "..........."});
  const std::vector<Zone> zones{one_way_box({1, 0}, {10, 1}, 0.0, 0.5),
                                one_way_box({1, 2}, {10, 3}, 3.14159, 0.5)};
  PlanOptions options;
  options.smoothing = false;
  const Plan plan = plan_checked(
      with_zones(ring, {robot_at(0.5, 0.5).to(10.5, 0.5), robot_at(10.5, 1.5).to(0.5, 1.5)}, zones), options);
  ASSERT_EQ(plan.plans.size(), 2U);
  EXPECT_NEAR(length_of(plan.plans[0]), 10.0, 1e-9);
  EXPECT_NEAR(length_of(plan.plans[1]), 12.0, 1e-9);  // by the upper corridor
}

TEST(PlannerZones, TheBorderOfASpeedZoneEndsAnAction) {
  const Problem problem = with_zones(OccupancyGrid(11, 3, 1.0), {robot_at(0.5, 1.5).to(10.5, 1.5)},
                                     {slow_box({4, -1}, {6, 4}, 0.5)});
  const Plan plan = plan_checked(problem);
  ASSERT_EQ(plan.plans.size(), 1U);
  const std::vector<Action>& actions = plan.plans[0].actions;
  ASSERT_EQ(actions.size(), 3U);
  for (const Action& action : actions) EXPECT_EQ(action.type, Action::Type::translate);
  EXPECT_NEAR(actions[0].t_end, 3.5, 1e-9);
  EXPECT_EQ(actions[1].t_start, actions[0].t_end);
  EXPECT_NEAR(actions[1].from.position.x(), 4.0, 1e-9);
  EXPECT_NEAR(actions[1].to.position.x(), 6.0, 1e-9);
  EXPECT_NEAR(actions[1].t_end, 7.5, 1e-9);
  EXPECT_NEAR(actions[2].t_end, 12.0, 1e-9);
  EXPECT_NEAR(plan.plans[0].cost, 12.0, 1e-9);
}

TEST(PlannerZones, OneAddedWaitServesTheWholeChainOfPieces) {
  const Problem problem = with_zones(OccupancyGrid(11, 3, 1.0), {robot_at(0.5, 1.5).to(10.5, 1.5)},
                                     {slow_box({4, -1}, {6, 4}, 0.5)});
  PlanOptions options;
  options.wait_before_move = 2.0;
  EXPECT_NEAR(plan_checked(problem, options).plans.at(0).cost, 14.0, 1e-9);
}

TEST(PlannerZones, GoesRoundAZoneThatIsSlowEnough) {
  const std::vector<Robot> robots{robot_at(0.5, 5.5).to(10.5, 5.5)};
  const auto cost = [&](double speed) {
    const Problem problem = with_zones(OccupancyGrid(11, 11, 1.0), robots, {slow_box({4, 3}, {7, 9}, speed)});
    return plan_checked(problem).plans.at(0).cost;
  };
  EXPECT_NEAR(cost(0.9), 7.0 + 3.0 / 0.9, 1e-9);
  EXPECT_LT(cost(0.1), 18.0);  // through it, 37 s
}

TEST(PlannerZones, TurnsSlowlyInASlowZone) {
  const std::vector<Robot> robots{robot_at(1.5, 1.5, 0.0).to(1.5, 1.5, 1.0).speeds(1.0, 1.0)};
  const Problem problem =
      with_zones(OccupancyGrid(3, 3, 1.0), robots, {slow_box({0, 0}, {3, 3}, Zone::kNoLimit, 0.25)});
  EXPECT_NEAR(plan_checked(problem).plans.at(0).cost, 4.0, 1e-9);
}

TEST(PlannerZones, RobotsMeetInASlowZone) {
  const std::vector<Robot> robots{robot_at(0.5, 1.5).to(10.5, 1.5), robot_at(10.5, 1.5).to(0.5, 1.5),
                                  robot_at(5.5, 0.5).to(5.5, 4.5)};
  const Problem problem = with_zones(OccupancyGrid(11, 5, 1.0), robots, {slow_box({3, 0}, {8, 3}, 0.3, 0.5)});
  EXPECT_TRUE(plan_checked(problem).unplanned.empty());
}

/// The detail of the only robot, which has no plan.
std::string detail_of(const Problem& problem, const PlanOptions& options = {}) {
  const Plan plan = plan_checked(problem, options);
  return plan.unplanned.size() == 1 ? plan.unplanned[0].detail : "";
}

TEST(ReasonsOfZones, NameThoseThatWallAStartIn) {
  std::vector<Zone> zones{blocked_box({0, 3}, {5, 4}), blocked_box({2, 7}, {3, 9}),
                          blocked_box({4, 0}, {5, 3.5})};
  zones[0].id = "north";
  zones[1].id = "aside";
  zones[2].id = "east";
  const std::vector<Robot> robots{robot_at(1.5, 1.5).to(9.5, 9.5)};
  EXPECT_THAT(detail_of(with_zones(OccupancyGrid(11, 11, 1.0), robots, zones)),
              HasSubstr("Without the zones \"north\" and \"east\", the robot would have a way."));
}

TEST(ReasonsOfZones, NameAOneWayZone) {
  const Problem problem = with_zones(OccupancyGrid(11, 3, 1.0), {robot_at(10.5, 1.5).to(0.5, 1.5)},
                                     {one_way_box({3, -1}, {8, 4}, 0.0)});
  EXPECT_THAT(detail_of(problem), HasSubstr("Without the zone \"box\", the robot would have a way."));
}

TEST(ReasonsOfZones, NameTheZoneThatAnInflatedGoalIsTooNearTo) {
  PlanOptions options;
  options.inflation = 0.3;
  const Problem problem =
      with_zones(OccupancyGrid(11, 3, 1.0), {robot_at(1.5, 1.5).to(7.5, 1.5)}, {blocked_box({8, 0}, {9, 3})});
  EXPECT_THAT(detail_of(problem, options), HasSubstr("Without the zone \"box\""));
}

TEST(ReasonsOfZones, NameNoneWhereWallsLeaveNoWay) {
  const OccupancyGrid halves = support::ascii_map({"...#...", "...#..."});
  const Problem problem =
      with_zones(halves, {robot_at(0.5, 0.5).to(6.5, 0.5)}, {blocked_box({1.5, -1}, {2, 3})});
  EXPECT_THAT(detail_of(problem), testing::Not(HasSubstr("zone")));
}

TEST(ProblemFaults, NameTheBlockedZone) {
  const auto faults_of = [](const Robot& robot, Zone zone) {
    ProblemConditions conditions;
    conditions.zones = {std::move(zone)};
    auto made =
        Problem::create(OccupancyGrid(11, 11, 1.0), {robot}, std::move(conditions), StopCondition::never());
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

}  // namespace TEST_FILE
}  // namespace fleetplan::core
