// Plans of robots inside zones that no robot enters, and of robots with goals there.

#include <gtest/gtest.h>

#include <cmath>

#include "core/geometry/polygon.h"
#include "tests/support/ascii_map.h"
#include "tests/support/expect_safe.h"
#include "tests/support/plan_checked.h"
#include "tests/support/problem_builder.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::ascii_map;
using support::plan_checked;
using support::robot_at;

/// A zone that nobody enters.
Zone closed(double left, double bottom, double right, double top) {
  Zone zone;
  zone.id = "closed";
  zone.may_leave = true;
  zone.polygon = {{left, bottom}, {right, bottom}, {right, top}, {left, top}};
  return zone;
}

Problem with_zones(OccupancyGrid grid, std::vector<Robot> robots, std::vector<Zone> zones,
                   double inflation = 0.0) {
  ProblemConditions conditions;
  conditions.zones = std::move(zones);
  conditions.inflation = inflation;
  return support::make_problem(std::move(grid), std::move(robots), std::move(conditions));
}

Robot to_goals(Robot robot, std::vector<Position> goals) {
  robot.goal = Goal{goals.back(), std::nullopt};
  goals.pop_back();
  for (const Position& goal : goals) robot.via.push_back({goal, std::nullopt});
  return robot;
}

/// The length of the way until the end of the first action that ends clear of the zone.
double way_inside(const RobotPlan& plan, const Zone& zone, double radius) {
  double length = 0.0;
  for (const Action& action : plan.actions) {
    length += (action.to.position - action.from.position).norm();
    if (distance_to_zone(zone, action.to.position) >= radius - 1e-6) break;
  }
  return length;
}

TEST(ClosedZone, ARobotInsideLeavesByTheShortestWayAndGoesOn) {
  // The goal is on the right, and the nearer border below.
  const Zone zone = closed(2, 1, 16, 9);
  const Problem problem = with_zones(OccupancyGrid(20, 12, 1.0), {robot_at(8.5, 2.5).to(18.5, 6.5)}, {zone});
  const Plan plan = plan_checked(problem);
  ASSERT_TRUE(plan.unplanned.empty());
  EXPECT_LE(way_inside(plan.plans[0], zone, 0.4), 1.5 + 0.4 + 1.0);
  EXPECT_NEAR(plan.plans[0].actions.back().to.position.x(), 18.5, 1e-9);
}

TEST(ClosedZone, NobodyEnters) {
  const Problem problem =
      with_zones(OccupancyGrid(20, 12, 1.0), {robot_at(0.5, 5.5).to(18.5, 5.5)}, {closed(5, 2, 12, 9)});
  const Plan plan = plan_checked(problem);
  ASSERT_TRUE(plan.unplanned.empty());
  EXPECT_GT(plan.plans[0].cost, 18.5) << "around";
}

TEST(ClosedZone, TheWayOutLeadsPastWalls) {
  const OccupancyGrid room = ascii_map({"..........",  //
                                        ".#######..",  //
                                        ".#.....#..",  //
                                        ".#.#.###..",  //
                                        ".#.#......",  //
                                        ".###......",  //
                                        ".........."});
  const Problem problem = with_zones(room, {robot_at(2.5, 2.5).to(0.5, 0.5)}, {closed(1, 1, 8, 6)});
  const Plan plan = plan_checked(problem);
  ASSERT_TRUE(plan.unplanned.empty()) << plan.unplanned[0].detail;
}

TEST(ClosedZone, OneWithoutAWayOutStays) {
  const OccupancyGrid room = ascii_map({"......",  //
                                        ".###..",  //
                                        ".#.#..",  //
                                        ".###..",  //
                                        "......"});
  const Problem problem = with_zones(room, {robot_at(2.5, 2.5).to(5.5, 0.5)}, {closed(1, 1, 4, 4)});
  const Plan plan = plan_checked(problem);
  ASSERT_EQ(plan.unplanned.size(), 1U);
}

Zone one_way(double heading, std::vector<Position> polygon) {
  Zone zone;
  zone.type = Zone::Type::one_way;
  zone.heading = heading;
  zone.half_angle = M_PI / 2;
  zone.polygon = std::move(polygon);
  return zone;
}

TEST(ClosedZone, TheWayToTheLatticeKeepsToOneWayZones) {
  // The one-way zones leave no vertex in sight of the start, and forbid the way over the fine lattice.
  Zone zone = closed(0, 0, 0, 0);
  zone.polygon = {{3.162214272200943, 12.826911581071993},
                  {-1.8854295208367917, 8.667358523234855},
                  {2.274123537000347, 3.6197147301971198},
                  {7.3217673300380826, 7.779267788034258}};
  const Zone down = one_way(-M_PI / 2, {{7.209957805438911, 2.6447975846119154},
                                        {8.694853984794117, 5.957533217426903},
                                        {7.030670598612676, 9.183928681957479},
                                        {3.47057167984374, 9.894442386938664},
                                        {0.6953843271037181, 7.55404302068135},
                                        {0.7948812205111708, 3.925099041424014},
                                        {3.6941391699635377, 1.7402792825141251}});
  const Zone up = one_way(M_PI / 2, {{1.2289318564837517, 6.999566733279428},
                                     {1.4509702674561882, 5.12164676266736},
                                     {1.4271662351295051, 4.127844537877317},
                                     {2.281653430082236, 3.470808047314353},
                                     {3.9622129361909475, 2.724379604994493},
                                     {5.270746623045822, 4.2812725051111205},
                                     {5.433069964802501, 6.688963044013017},
                                     {2.981820113028824, 6.65329503622836}});
  const Robot robot = robot_at(2.865507187386706, 3.814680262766844, 1.8265859830088944)
                          .radius(0.6)
                          .speeds(0.22624350825196715, 2.0853056573105393)
                          .to(2.5, 9.5);
  const Plan plan = plan_checked(with_zones(OccupancyGrid(8, 11, 1.0), {robot}, {zone, down, up}));
  ASSERT_EQ(plan.plans.size(), 1U);
  EXPECT_TRUE(plan.plans[0].actions.empty()) << "it stays";
}

TEST(ClosedZone, ALaterGoalInsideIsPutOffAndNotThoseBefore) {
  const Problem problem = with_zones(OccupancyGrid(20, 12, 1.0),
                                     {to_goals(robot_at(0.5, 0.5), {{2.5, 9.5}, {8.5, 5.5}, {18.5, 0.5}})},
                                     {closed(5, 2, 12, 9)});
  const Leaving& leaving = *problem.leaving(0);
  ASSERT_TRUE(leaving.postponed);
  EXPECT_EQ(leaving.postponed->first, 1U);
  EXPECT_EQ(leaving.postponed->count, 2U);
  EXPECT_EQ(leaving.postponed->zone, 0U);
  EXPECT_TRUE(leaving.way_out.empty());
  const Plan plan = plan_checked(problem);
  ASSERT_TRUE(plan.unplanned.empty());
  ASSERT_EQ(plan.plans[0].visits.size(), 1U);
  EXPECT_EQ(plan.plans[0].actions.back().to.position, Position(2.5, 9.5));
}

TEST(ClosedZone, OneWhoseGoalsAreAllPutOffStaysOutsideOrLeaves) {
  const std::vector<Robot> robots{robot_at(0.5, 0.5).to(8.5, 4.5), robot_at(8.5, 7.5).to(6.5, 5.5),
                                  robot_at(9.5, 7.5).to(10.5, 5.5), robot_at(0.5, 10.5).to(9.5, 10.5)};
  const Zone zone = closed(5, 2, 12, 9);
  const Problem problem = with_zones(OccupancyGrid(20, 12, 1.0), robots, {zone});
  const Plan plan = plan_checked(problem);
  ASSERT_TRUE(plan.unplanned.empty()) << plan.unplanned[0].detail;
  EXPECT_TRUE(plan.plans[0].actions.empty());
  for (const std::size_t robot : {1U, 2U}) {
    EXPECT_EQ(problem.robots()[robot].goal->position, problem.leaving(robot)->way_out.back());
    EXPECT_GE(distance_to_zone(zone, plan.plans[robot].actions.back().to.position), 0.4 - 1e-6);
  }
}

TEST(ClosedZone, ACommitmentMayEndInside) {
  const Zone zone = closed(5, 2, 12, 9);
  const Problem problem =
      with_zones(OccupancyGrid(20, 12, 1.0), {robot_at(3.5, 5.5).drives(6.0, 5.5).to(18.5, 5.5)}, {zone});
  const Plan plan = plan_checked(problem);
  ASSERT_TRUE(plan.unplanned.empty());
  EXPECT_LE(way_inside(plan.plans[0], zone, 0.4), 2.5 + 2.5);
}

TEST(ClosedZone, InflationKeepsARobotAwayFromItOnceItIsOutside) {
  const Zone zone = closed(5, 2, 12, 9);
  PlanOptions options;
  options.inflation = 0.3;
  const Problem problem =
      with_zones(OccupancyGrid(20, 12, 1.0), {robot_at(8.5, 3.5).to(18.5, 5.5)}, {zone}, options.inflation);
  const Plan plan = core::plan(problem, options, StopCondition::never());
  ASSERT_TRUE(plan.unplanned.empty());
  support::expect_safe(problem, plan.plans);
  EXPECT_GE(distance_to_zone(zone, problem.leaving(0)->way_out.back()), 0.7 - 1e-6);
}

TEST(ClosedZone, RobotsThatMayReverseLeaveBackwards) {
  const Zone zone = closed(5, 2, 12, 9);
  Robot robot = robot_at(8.5, 3.5, 0.5 * 3.141592653589793).to(18.5, 5.5);
  robot.may_reverse = true;
  const Plan plan = plan_checked(with_zones(OccupancyGrid(20, 12, 1.0), {robot}, {zone}));
  ASSERT_TRUE(plan.unplanned.empty());
  EXPECT_TRUE(plan.plans[0].actions.front().reverse);
}

TEST(ClosedZone, IsForItsRobots) {
  Zone zone = closed(5, 2, 12, 9);
  zone.robots = {1};
  const Problem problem = with_zones(
      OccupancyGrid(20, 12, 1.0), {robot_at(0.5, 5.5).to(8.5, 5.5), robot_at(0.5, 8.5).to(8.5, 3.5)}, {zone});
  const Plan plan = plan_checked(problem);
  EXPECT_FALSE(problem.leaving(0)->postponed);
  EXPECT_FALSE(plan.plans[0].actions.empty());
  EXPECT_TRUE(plan.plans[1].actions.empty());
}

/// The checker's own view of it.
VerifyReport checked(const Problem& problem, const std::vector<Robot>& robots, std::vector<Action> actions) {
  CheckRules rules;
  rules.tolerances.assign(robots.size(), Tolerance::of_all(kMaxTolerance));
  const double cost = actions.empty() ? 0.0 : actions.back().t_end;
  return *verify({problem.grid(), robots, {}, &problem.zones()}, {{0, cost, std::move(actions)}}, rules,
                 StopCondition::never());
}

TEST(ClosedZoneCheck, ARobotThatIsOutsideMustNotComeBack) {
  const std::vector<Robot> robots{to_goals(robot_at(6.5, 5.5), {{3.5, 5.5}})};
  const Problem problem = with_zones(OccupancyGrid(20, 12, 1.0), robots, {closed(5, 2, 12, 9)});
  const Pose inside{{6.5, 5.5}, 0.0};
  const Pose outside{{3.5, 5.5}, 0.0};
  const auto drive = [](double t, const Pose& from, const Pose& to) {
    return Action{Action::Type::translate, t, t + 3.0, from, to};
  };
  EXPECT_TRUE(checked(problem, robots, {drive(0.0, inside, outside)}).valid());
  const VerifyReport back =
      checked(problem, robots,
              {drive(0.0, inside, outside), drive(3.0, outside, inside), drive(6.0, inside, outside)});
  ASSERT_FALSE(back.valid());
  EXPECT_EQ(back.violations[0].kind, Violation::Kind::zone);
}

TEST(ClosedZoneCheck, GoalsInsideMayBeLeftButNotThoseBefore) {
  const std::vector<Robot> robots{to_goals(robot_at(3.5, 0.5), {{0.5, 0.5}, {8.5, 5.5}})};
  const Problem problem = with_zones(OccupancyGrid(20, 12, 1.0), robots, {closed(5, 2, 12, 9)});
  const Action drive{Action::Type::translate, 0.0, 3.0, {{3.5, 0.5}, 0.0}, {{0.5, 0.5}, 0.0}};
  EXPECT_TRUE(checked(problem, robots, {drive}).valid());
  const VerifyReport none = checked(problem, robots, {});
  ASSERT_EQ(none.violations.size(), 1U);
  EXPECT_EQ(none.violations[0].kind, Violation::Kind::wrong_visit);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
