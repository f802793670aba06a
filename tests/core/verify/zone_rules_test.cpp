// The checker's rules of zones.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "tests/core/verify/scene.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::PlanBuilder;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// The square from (5, 5) to (10, 10).
Zone square(Zone::Type type) {
  Zone zone;
  zone.id = "ward";
  zone.type = type;
  zone.polygon = {{5, 5}, {10, 5}, {10, 10}, {5, 10}};
  return zone;
}

/// The violations of one robot among these zones.
std::vector<Violation> violations(const std::vector<Zone>& zones, const Robot& robot,
                                  const std::function<void(PlanBuilder&)>& drive) {
  PlanBuilder plan(0, robot);
  drive(plan);
  std::vector<Robot> robots{robot};
  const std::vector<RobotPlan> plans{plan.build()};
  const auto& last = plans[0].actions.back().to;
  robots[0].goal = Goal{last.position, last.theta};
  const OccupancyGrid grid = open_map();
  const std::vector<MovingObstacle> none;
  CheckRules rules;
  rules.tolerances.assign(1, Tolerance::of_all(kTolerance));
  return verify({grid, robots, none, &zones}, plans, rules, StopCondition::never())->violations;
}

TEST(ZoneRules, ADiskMayTouchABlockedZone) {
  const std::vector<Zone> zones{square(Zone::Type::blocked)};
  const auto along = [](double y) { return [y](PlanBuilder& plan) { plan.translate_to(15, y); }; };
  EXPECT_THAT(violations(zones, robot_at(1, 4.5), along(4.5)), IsEmpty());
  const auto found = violations(zones, robot_at(1, 4.6), along(4.6));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].kind, Kind::zone);
  EXPECT_EQ(found[0].zone, 0U);
  EXPECT_THAT(found[0].robots, ElementsAre(0));
  EXPECT_NEAR(found[0].distance, 0.4, 1e-12);
  EXPECT_EQ(found[0].required, 0.5);
  EXPECT_THAT(found[0].detail, testing::HasSubstr("0.1 m into the blocked zone \"ward\""));
}

TEST(ZoneRules, OneOverlapIsOneViolation) {
  const std::vector<Zone> zones{square(Zone::Type::blocked)};
  const auto found = violations(zones, robot_at(1, 7), [](PlanBuilder& plan) {
    plan.translate_to(7, 7).wait(3).translate_to(8, 7).translate_to(15, 7).wait(1);
    plan.rotate_to(3.14159265).drive_to(1, 7);
  });
  ASSERT_EQ(found.size(), 2U);
  EXPECT_NEAR(found[0].t, 4.0, 1e-9);  // the centre comes to the border
  EXPECT_EQ(found[0].distance, 0.0);
}

TEST(ZoneRules, ActionsInASpeedZoneAreSlow) {
  std::vector<Zone> zones{square(Zone::Type::speed)};
  zones[0].linear_speed = 0.5;
  zones[0].angular_speed = 0.25;
  const auto drive = [](double speed) {
    return [speed](PlanBuilder& plan) {
      plan.translate_to(5, 7).translate_to(10, 7, speed).translate_to(15, 7);
    };
  };
  EXPECT_THAT(violations(zones, robot_at(1, 7), drive(0.5)), IsEmpty());
  EXPECT_THAT(violations(zones, robot_at(1, 7), drive(0.2)), IsEmpty());
  const auto found = violations(zones, robot_at(1, 7), drive(0.6));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].kind, Kind::zone);
  EXPECT_EQ(found[0].zone, 0U);
  EXPECT_NEAR(found[0].distance, 0.6, 1e-9);
  EXPECT_EQ(found[0].required, 0.5);
  EXPECT_NEAR(found[0].t, 4.0, 1e-9);
  const auto across = violations(zones, robot_at(1, 7), [](PlanBuilder& plan) { plan.translate_to(15, 7); });
  ASSERT_EQ(across.size(), 1U);
  EXPECT_NEAR(across[0].t, 4.0, 1e-9);
  const auto turn = violations(zones, robot_at(7, 7), [](PlanBuilder& plan) { plan.rotate_to(1.0); });
  ASSERT_EQ(turn.size(), 1U);
  EXPECT_EQ(turn[0].required, 0.25);
  EXPECT_THAT(violations(zones, robot_at(5, 7), [](PlanBuilder& plan) { plan.rotate_to(1.0); }), IsEmpty());
}

TEST(ZoneRules, TranslationsKeepWithinTheAngleOfAOneWayZone) {
  std::vector<Zone> zones{square(Zone::Type::one_way)};
  zones[0].heading = 0.0;
  zones[0].half_angle = 1.0;
  const auto drive = [](double x, double y) { return [x, y](PlanBuilder& plan) { plan.drive_to(x, y); }; };
  EXPECT_THAT(violations(zones, robot_at(1, 7), drive(15, 7)), IsEmpty());
  EXPECT_THAT(violations(zones, robot_at(6, 6), drive(7, 7)), IsEmpty());
  EXPECT_THAT(violations(zones, robot_at(15, 10), drive(1, 10)), IsEmpty());  // along the border
  const auto up = violations(zones, robot_at(7, 1), drive(7, 15));
  ASSERT_EQ(up.size(), 1U);
  EXPECT_NEAR(up[0].distance, 1.5707963, 1e-6);
  EXPECT_EQ(up[0].required, 1.0);
  EXPECT_EQ(violations(zones, robot_at(15, 9.9), drive(1, 9.9)).size(), 1U);
}

TEST(ZoneRules, AGoalOnTheBorderOfAClosedZoneIsVisitedOrPutOff) {
  std::vector<Zone> zones{square(Zone::Type::blocked)};
  zones[0].may_leave = true;
  const auto is_valid = [&](double overlap, double end, double theta) {
    std::vector<Robot> robots{robot_at(1, 7)};
    robots[0].goal = Goal{{4.5 + overlap, 7}, theta};
    PlanBuilder plan(0, robots[0]);
    plan.translate_to(end, 7);
    const OccupancyGrid grid = open_map();
    const std::vector<MovingObstacle> none;
    CheckRules rules;
    rules.tolerances.assign(1, Tolerance::of_all(1e-6));
    const auto report = verify({grid, robots, none, &zones}, {plan.build()}, rules, StopCondition::never());
    return report->violations.empty();
  };
  for (const double within : {-9e-7, -1e-12, 0.0, 1e-12, 9e-7}) {
    EXPECT_TRUE(is_valid(within, 4.5 + within, 0.0)) << "visited, " << within;
    EXPECT_TRUE(is_valid(within, 4.5 + within, 1.0)) << "put off in the same place, " << within;
    EXPECT_TRUE(is_valid(within, 3.0, 0.0)) << "put off, " << within;
  }
  EXPECT_FALSE(is_valid(2e-6, 4.5 + 2e-6, 0.0)) << "inside";
  EXPECT_TRUE(is_valid(2e-6, 3.0, 0.0)) << "inside";
  EXPECT_TRUE(is_valid(-2e-6, 4.5 - 2e-6, 0.0)) << "outside";
  EXPECT_FALSE(is_valid(-2e-6, 3.0, 0.0)) << "outside";
}

TEST(ZoneRules, ARobotWhoseGoalsAreAllPutOffStaysAsOneWithoutAGoal) {
  std::vector<Zone> zones{square(Zone::Type::blocked)};
  zones[0].may_leave = true;
  std::vector<Robot> robots{robot_at(2, 2)};
  robots[0].goal = Goal{{7, 7}, std::nullopt};
  const std::vector<MovingObstacle> passing{{"person", 0.3, {{0.0, {2, 9}}, {9.0, {2, 0}}}}};
  const OccupancyGrid grid = open_map();
  CheckRules rules;
  rules.tolerances.assign(1, Tolerance::of_all(kTolerance));
  rules.exempt = {{0, std::nullopt, 0, 6.2}};
  const RobotPlan staying{0, 0.0, {}};
  const auto report = verify({grid, robots, passing, &zones}, {staying}, rules, StopCondition::never());
  EXPECT_THAT(report->violations, IsEmpty()) << "nothing prevents this collision";
}

TEST(ZoneRules, AZoneMayBeForSomeRobotsOnly) {
  std::vector<Zone> zones{square(Zone::Type::blocked)};
  zones[0].robots = {1};
  EXPECT_THAT(violations(zones, robot_at(1, 7), [](PlanBuilder& plan) { plan.translate_to(15, 7); }),
              IsEmpty());
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
