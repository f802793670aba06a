// Continuity and speed: valid plans broken in one place each.
// Added waits: robots stand still, already turned, before they move.
// Plans have to begin with the committed actions.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "tests/core/verify/scene.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::PlanBuilder;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr double kPi = std::numbers::pi;

/// (5, 5) -> (8, 5), waits, turns left, -> (8, 9): four actions that end at 3, 5, 5 + pi/2 and 9 + pi/2 s.
Scene valid_scene() {
  Scene scene;
  scene.add(robot_at(5, 5),
            [](PlanBuilder& plan) { plan.translate_to(8, 5).wait(2).rotate_to(kPi / 2).translate_to(8, 9); });
  return scene;
}

void shift(Scene& scene, std::size_t first, double seconds) {
  for (std::size_t k = first; k < scene.plans()[0].actions.size(); ++k) {
    scene.action(k).t_start += seconds;
    scene.action(k).t_end += seconds;
  }
  scene.plans()[0].cost += seconds;
}

TEST(Discontinuity, AcceptsAContiguousPlan) { EXPECT_THAT(valid_scene().violations(), IsEmpty()); }

TEST(Discontinuity, RequiresAPlanToStartAtTimeZero) {
  Scene scene = valid_scene();
  shift(scene, 0, 0.5);
  const auto violations = scene.violations();
  ASSERT_THAT(kinds_of(violations), ElementsAre(Kind::discontinuity));
  EXPECT_EQ(violations[0].distance, 0.5);
  EXPECT_EQ(violations[0].required, 0.0);
  EXPECT_EQ(violations[0].detail, "actions[0] starts at t = 0.5 s, but a plan starts at t = 0 s");
}

TEST(Discontinuity, ReportsGapsInTimeAboveTheTolerance) {
  Scene scene = valid_scene();
  shift(scene, 2, 0.5 * kTolerance);
  EXPECT_THAT(scene.violations(), IsEmpty());
  shift(scene, 2, 0.25);
  const auto violations = scene.violations();
  ASSERT_THAT(kinds_of(violations), ElementsAre(Kind::discontinuity));
  EXPECT_NEAR(violations[0].distance, 5.25, 1e-5);
  EXPECT_NEAR(violations[0].required, 5.0, 1e-5);
}

TEST(Discontinuity, ReportsActionsThatOverlapInTime) {
  Scene scene = valid_scene();
  shift(scene, 1, -1.0);
  EXPECT_THAT(kinds_of(scene.violations()), ElementsAre(Kind::discontinuity));
}

TEST(Discontinuity, ReportsAnActionThatEndsBeforeItStarts) {
  Scene scene = valid_scene();
  scene.action(1).t_end = 2.0;
  for (std::size_t k = 2; k < 4; ++k) {
    scene.action(k).t_start -= 3.0;
    scene.action(k).t_end -= 3.0;
  }
  scene.plans()[0].cost -= 3.0;
  const auto violations = scene.violations();
  ASSERT_THAT(kinds_of(violations), ElementsAre(Kind::discontinuity));
  EXPECT_EQ(violations[0].distance, 2.0);
  EXPECT_EQ(violations[0].required, 3.0);
}

TEST(Discontinuity, ReportsJumpsInSpace) {
  Scene scene = valid_scene();
  scene.action(1).from.position.x() += 0.5;
  scene.action(1).to.position.x() += 0.5;
  const auto violations = scene.violations();  // there and back
  ASSERT_THAT(kinds_of(violations), ElementsAre(Kind::discontinuity, Kind::discontinuity));
  EXPECT_NEAR(violations[0].distance, 0.5, 1e-12);
  EXPECT_EQ(violations[0].t, 3.0);
  EXPECT_EQ(violations[0].detail, "actions[1] starts 0.5 m from where the action before ends");
}

TEST(Discontinuity, ReportsJumpsOfTheHeadingModuloAFullTurn) {
  Scene scene = valid_scene();
  scene.action(1).from.theta += 2.0 * kPi;
  scene.action(1).to.theta -= 4.0 * kPi;
  EXPECT_THAT(scene.violations(), IsEmpty());
  scene.action(1).from.theta = 0.25;
  scene.action(1).to.theta = 0.25;
  const auto violations = scene.violations();
  ASSERT_THAT(kinds_of(violations), ElementsAre(Kind::discontinuity, Kind::discontinuity));
  EXPECT_NEAR(violations[0].distance, 0.25, 1e-12);
}

TEST(Discontinuity, ReportsAWaitThatMoves) {
  Scene scene = valid_scene();
  scene.action(0).type = Action::Type::wait;
  const auto violations = scene.violations();
  ASSERT_THAT(kinds_of(violations), ElementsAre(Kind::discontinuity));
  EXPECT_EQ(violations[0].detail, "actions[0] waits, but moves by 3 m");
}

TEST(Discontinuity, ReportsARotationThatMoves) {
  Scene scene = valid_scene();
  scene.action(0).type = Action::Type::rotate;
  EXPECT_THAT(kinds_of(scene.violations()), ElementsAre(Kind::discontinuity));
}

TEST(Discontinuity, ReportsAWaitOrTranslationThatTurns) {
  Scene scene = valid_scene();
  scene.action(2).type = Action::Type::wait;
  EXPECT_THAT(kinds_of(scene.violations()), ElementsAre(Kind::discontinuity));
  scene.action(2).type = Action::Type::translate;
  const auto violations = scene.violations();
  ASSERT_THAT(kinds_of(violations), ElementsAre(Kind::discontinuity));
  EXPECT_NEAR(violations[0].distance, kPi / 2, 1e-12);
}

TEST(Discontinuity, RequiresTheCostToBeTheEndOfTheLastAction) {
  Scene scene = valid_scene();
  scene.plans()[0].cost += 0.5;
  const auto violations = scene.violations();
  ASSERT_THAT(kinds_of(violations), ElementsAre(Kind::discontinuity));
  EXPECT_NEAR(violations[0].distance - violations[0].required, 0.5, 1e-12);

  Scene standing;
  standing.add(robot_at(5, 5), [](PlanBuilder&) {});
  EXPECT_THAT(standing.violations(), IsEmpty());
  standing.plans()[0].cost = 1.0;
  EXPECT_THAT(kinds_of(standing.violations()), ElementsAre(Kind::discontinuity));
}

TEST(Discontinuity, ReportsAMoveThatEndsBeforeItStartsAsTooFast) {
  Scene scene;
  scene.add(robot_at(5, 5), [](PlanBuilder& plan) { plan.translate_to(8, 5); });
  scene.action(0).t_end = scene.plans()[0].cost = -2.0;
  const auto violations = scene.violations();
  ASSERT_THAT(kinds_of(violations), ElementsAre(Kind::discontinuity, Kind::speed));
  EXPECT_EQ(violations[1].distance, 0.0);
  EXPECT_EQ(violations[1].required, 3.0);
}

TEST(Discontinuity, ExcludesRobotsWithUnusableNumbersFromOtherChecks) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                           -std::numeric_limits<double>::infinity(), 1e300}) {
    Scene scene = valid_scene();
    scene.stand(robot_at(8, 5)).stand(robot_at(1, 1)).stand(robot_at(1.75, 1));
    EXPECT_THAT(kinds_of(scene.violations()), ElementsAre(Kind::robot_collision, Kind::robot_collision));
    scene.action(1).t_end = bad;
    const auto report = scene.check();
    ASSERT_THAT(kinds_of(report.violations), ElementsAre(Kind::robot_collision, Kind::discontinuity)) << bad;
    EXPECT_THAT(report.violations[0].robots, ElementsAre(2, 3));
    EXPECT_THAT(report.violations[1].robots, ElementsAre(0));
    EXPECT_EQ(report.violations[1].t, 3.0);
    EXPECT_THAT(report.violations[1].detail, HasSubstr("actions[1] has a number that is not finite"));
    EXPECT_NEAR(*report.min_clearance, -0.25, 1e-12);
  }
}

TEST(Discontinuity, ChecksEveryNumberOfARobotAndItsPlan) {
  const std::vector<double* (*)(Scene&)> numbers = {
      [](Scene& scene) { return &scene.action(2).t_start; },
      [](Scene& scene) { return &scene.action(2).t_end; },
      [](Scene& scene) { return &scene.action(2).from.position.x(); },
      [](Scene& scene) { return &scene.action(2).from.position.y(); },
      [](Scene& scene) { return &scene.action(2).from.theta; },
      [](Scene& scene) { return &scene.action(2).to.position.x(); },
      [](Scene& scene) { return &scene.action(2).to.position.y(); },
      [](Scene& scene) { return &scene.action(2).to.theta; },
      [](Scene& scene) { return &scene.plans()[0].cost; },
      [](Scene& scene) { return &scene.robots()[0].radius; },
      [](Scene& scene) { return &scene.robots()[0].linear_speed; },
      [](Scene& scene) { return &scene.robots()[0].angular_speed; },
      [](Scene& scene) { return &scene.robots()[0].start.position.x(); },
      [](Scene& scene) { return &scene.robots()[0].start.position.y(); },
      [](Scene& scene) { return &scene.robots()[0].start.theta; },
      [](Scene& scene) { return &scene.robots()[0].goal->position.x(); },
      [](Scene& scene) { return &scene.robots()[0].goal->position.y(); },
      [](Scene& scene) { return &*scene.robots()[0].goal->theta; },
  };
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    Scene scene = valid_scene();
    *numbers[k](scene) = std::numeric_limits<double>::quiet_NaN();
    const auto violations = scene.violations();
    ASSERT_THAT(kinds_of(violations), ElementsAre(Kind::discontinuity)) << k;
    EXPECT_THAT(violations[0].detail, HasSubstr("left out of all other checks")) << k;
  }
}

TEST(Speed, RejectsFasterMovesThanTheRobots) {
  const auto drive_at = [](double speed) {
    Scene scene;
    scene.add(robot_at(5, 5), [speed](PlanBuilder& plan) { plan.translate_to(8, 5, speed); });
    return scene.violations();
  };
  EXPECT_THAT(drive_at(0.1), IsEmpty());
  EXPECT_THAT(drive_at(1.0), IsEmpty());
  const auto violations = drive_at(1.25);
  ASSERT_THAT(kinds_of(violations), ElementsAre(Kind::speed));
  EXPECT_NEAR(violations[0].distance, 1.25, 1e-12);
  EXPECT_EQ(violations[0].required, 1.0);
  EXPECT_EQ(violations[0].detail, "actions[0] goes at 1.25 m/s, but the robot can do no more than 1 m/s");
}

TEST(Speed, AllowsTheToleranceInSeconds) {
  Scene scene = valid_scene();
  scene.action(3).t_end -= 0.5 * kTolerance;
  EXPECT_THAT(scene.violations(), IsEmpty());
  scene.action(3).t_end -= 1.5 * kTolerance;
  scene.plans()[0].cost = scene.action(3).t_end;
  EXPECT_THAT(kinds_of(scene.violations()), ElementsAre(Kind::speed));
}

TEST(Speed, AllowsASlowRobotTheToleranceInMetres) {
  const auto drive_too_far_by = [](double excess) {
    Scene scene;
    Robot slow = robot_at(5, 5);
    slow.linear_speed = 1e-9;
    scene.add(slow, [](PlanBuilder& plan) { plan.translate_to(8, 5); });
    scene.action(0).to.position.x() += excess;
    return scene.violations();
  };
  EXPECT_THAT(drive_too_far_by(0.5 * kTolerance), IsEmpty()) << "though 500 s are missing";
  EXPECT_THAT(kinds_of(drive_too_far_by(2.0 * kTolerance)), testing::Contains(Kind::speed));
}

TEST(Speed, MeasuresRotationsInTheShorterDirection) {
  Scene scene;
  scene.add(robot_at(5, 5, 3.0), [](PlanBuilder& plan) { plan.rotate_to(-3.0); });
  EXPECT_NEAR(scene.plans()[0].cost, 2.0 * kPi - 6.0, 1e-12);
  EXPECT_THAT(scene.violations(), IsEmpty());
  scene.action(0).t_end = scene.plans()[0].cost = 0.2;
  const auto violations = scene.violations();
  ASSERT_THAT(kinds_of(violations), ElementsAre(Kind::speed));
  EXPECT_NEAR(violations[0].distance, (2.0 * kPi - 6.0) / 0.2, 1e-12);
}

TEST(Speed, ReportsAMoveWithoutDurationInSeconds) {
  Scene scene = valid_scene();
  scene.action(0).t_end = 0.0;
  shift(scene, 1, -3.0);
  const auto violations = scene.violations();
  ASSERT_THAT(kinds_of(violations), ElementsAre(Kind::speed));
  EXPECT_EQ(violations[0].distance, 0.0);
  EXPECT_NEAR(violations[0].required, 3.0, 1e-12);
  EXPECT_EQ(violations[0].detail, "actions[0] takes 0 s, but the robot needs at least 3 s");
}

TEST(Speed, ReportsFiniteNumbersForAnExtremelySlowRobot) {
  Scene scene = valid_scene();
  scene.robots()[0].linear_speed = std::numeric_limits<double>::denorm_min();
  scene.action(0).t_end = 0.0;
  shift(scene, 1, -3.0);
  const auto violations = scene.violations();
  ASSERT_THAT(kinds_of(violations), ElementsAre(Kind::speed, Kind::speed));
  EXPECT_TRUE(std::isfinite(violations[0].required));
}

TEST(Speed, AllowsBackwardsButNotSidewaysMoves) {
  const auto drive_heading = [](double theta) {
    Scene scene;
    scene.add(robot_at(5, 5, theta), [](PlanBuilder& plan) { plan.translate_to(8, 5); });
    return scene.violations();
  };
  EXPECT_THAT(drive_heading(0.0), IsEmpty());
  EXPECT_THAT(drive_heading(kPi), IsEmpty());
  EXPECT_THAT(drive_heading(0.5 * kTolerance / 3.0), IsEmpty());
  const auto violations = drive_heading(kPi / 6);
  ASSERT_THAT(kinds_of(violations), ElementsAre(Kind::speed));
  EXPECT_NEAR(violations[0].distance, 1.5, 1e-12);
  EXPECT_EQ(violations[0].required, 0.0);
  EXPECT_THAT(violations[0].detail, HasSubstr("1.5 m sideways"));
}

TEST(Speed, AllowsAVeryShortMoveAnyHeading) {
  Scene scene;
  scene.add(robot_at(5, 5), [](PlanBuilder& plan) { plan.translate_to(5, 5 + 0.5 * kTolerance); });
  EXPECT_THAT(scene.violations(), IsEmpty());
}

Scene backing(bool may_reverse) {
  Robot robot = robot_at(8, 10);
  robot.may_reverse = may_reverse;
  Scene scene;
  scene.add(robot, [](support::PlanBuilder& plan) { plan.translate_to(4, 10); });
  scene.action(0).reverse = true;
  return scene;
}

TEST(ReverseRules, ARobotThatMayReverseGoesBack) { EXPECT_TRUE(backing(true).violations().empty()); }

TEST(ReverseRules, ARobotThatMayNotReverseIsReported) {
  const auto violations = backing(false).violations();
  ASSERT_EQ(violations.size(), 1U);
  EXPECT_EQ(violations[0].kind, Kind::speed);
  EXPECT_NE(violations[0].detail.find("the robot may not"), std::string::npos) << violations[0].detail;
}

TEST(ReverseRules, AMoveAheadIsNoReverseOne) {
  Scene scene = backing(true);
  scene.action(0).from.theta = scene.action(0).to.theta = 3.141592653589793;
  scene.robots()[0].start.theta = scene.robots()[0].goal->theta.emplace(3.141592653589793);
  const auto violations = scene.violations();
  ASSERT_EQ(violations.size(), 1U);
  EXPECT_EQ(violations[0].kind, Kind::speed);
  EXPECT_NEAR(violations[0].distance, 4.0, 1e-9);
}

constexpr double kQuarter = std::numbers::pi / 2;

template <typename Build>
Scene scene_of(Build build) {
  Scene scene;
  scene.add(robot_at(2, 5), build);
  return scene;
}

CheckRules wait_of(double seconds) {
  CheckRules rules;
  rules.wait_before_move = seconds;
  return rules;
}

TEST(AddedWaits, PrecedeEveryTranslation) {
  const Scene scene = scene_of([](PlanBuilder& plan) {
    plan.wait(2).translate_to(5, 5).rotate_to(kQuarter).wait(1).wait(1).translate_to(5, 8);
  });
  EXPECT_THAT(scene.violations(wait_of(2)), IsEmpty());
  const auto violations = scene.violations(wait_of(2.5));
  ASSERT_THAT(kinds_of(violations), ElementsAre(Kind::speed, Kind::speed));
  EXPECT_DOUBLE_EQ(violations[0].t, 2.0);
  EXPECT_DOUBLE_EQ(violations[0].distance, 2.0);
  EXPECT_DOUBLE_EQ(violations[0].required, 2.5);
  EXPECT_EQ(violations[0].detail,
            "actions[1] follows a stand-still of 2 s, but robots wait 2.5 s before they move");
}

TEST(AddedWaits, CountOnlyOnceTheRobotHasTurned) {
  const Scene scene =
      scene_of([](PlanBuilder& plan) { plan.wait(5).rotate_to(kQuarter).translate_to(2, 8); });
  EXPECT_THAT(kinds_of(scene.violations(wait_of(2))), ElementsAre(Kind::speed));
}

TEST(AddedWaits, AreNotNeededWithinAStraightLine) {
  const Scene scene = scene_of(
      [](PlanBuilder& plan) { plan.wait(2).translate_to(5, 5).translate_to(7, 5, 0.5).translate_to(9, 5); });
  EXPECT_THAT(scene.violations(wait_of(2)), IsEmpty());
  const Scene back = scene_of([](PlanBuilder& plan) { plan.wait(2).translate_to(5, 5).translate_to(3, 5); });
  EXPECT_THAT(kinds_of(back.violations(wait_of(2))), ElementsAre(Kind::speed));
}

TEST(AddedWaits, AreNotJudgedInCommittedActions) {
  Scene scene = scene_of(
      [](PlanBuilder& plan) { plan.translate_to(5, 5).rotate_to(kQuarter).wait(2).translate_to(5, 8); });
  EXPECT_EQ(scene.violations(wait_of(2)).size(), 1U);
  scene.robots()[0].committed = {scene.action(0)};
  EXPECT_THAT(scene.violations(wait_of(2)), IsEmpty());
}

TEST(AddedWaits, MayHaveBegunBeforeTheCommitment) {
  Scene scene = scene_of([](PlanBuilder& plan) { plan.wait(0.5).translate_to(5, 5); });
  EXPECT_EQ(scene.violations(wait_of(2)).size(), 1U);
  scene.robots()[0].committed = {scene.action(0)};
  EXPECT_THAT(scene.violations(wait_of(2)), IsEmpty());
}

/// A robot that drives, turns and drives; the first `committed` actions are committed.
Scene committed_to(std::size_t committed) {
  Scene scene;
  scene.add(robot_at(2, 5), [](PlanBuilder& plan) {
    plan.translate_to(5, 5).rotate_to(1.0).wait(2).rotate_to(0.0).translate_to(9, 5);
  });
  const auto& actions = scene.plans()[0].actions;
  scene.robots()[0].committed.assign(actions.begin(),
                                     actions.begin() + static_cast<std::ptrdiff_t>(committed));
  return scene;
}

CheckRules exactly() {
  CheckRules rules;
  rules.exact_commitments = true;
  return rules;
}

TEST(Commitments, AreWhatThePlanBeginsWith) {
  for (std::size_t committed = 0; committed <= 5; ++committed) {
    EXPECT_THAT(committed_to(committed).violations(CheckRules{}), IsEmpty());
    EXPECT_THAT(committed_to(committed).violations(exactly()), IsEmpty());
  }
}

TEST(Commitments, AreReportedOnceIfAnyNumberChanges) {
  Scene scene = committed_to(3);
  scene.robots()[0].committed[1].to.theta += 0.25;
  scene.robots()[0].committed[2].from.theta += 0.25;
  const auto violations = scene.violations(CheckRules{});
  ASSERT_THAT(kinds_of(violations), ElementsAre(Kind::committed_changed));
  EXPECT_DOUBLE_EQ(violations[0].t, 3.0);
  EXPECT_NEAR(violations[0].distance, 0.25, 1e-12);
  EXPECT_EQ(violations[0].detail, "actions[1] ends with a heading 0.25 rad off the committed action");
}

TEST(Commitments, MayDifferWithinTheToleranceUnlessExact) {
  Scene scene = committed_to(1);
  scene.robots()[0].committed[0].t_end += 1e-8;
  EXPECT_THAT(scene.violations(CheckRules{}), IsEmpty());
  EXPECT_THAT(kinds_of(scene.violations(exactly())), ElementsAre(Kind::committed_changed));
}

TEST(Commitments, OfAnotherTypeOrNumberAreReported) {
  Scene scene = committed_to(4);
  scene.plans()[0].actions.resize(3);
  scene.plans()[0].cost = scene.plans()[0].actions.back().t_end;
  scene.robots()[0].goal.reset();
  const auto violations = scene.violations(CheckRules{});
  ASSERT_FALSE(violations.empty());
  const auto changed = std::find_if(violations.begin(), violations.end(),
                                    [](const Violation& v) { return v.kind == Kind::committed_changed; });
  ASSERT_NE(changed, violations.end());
  EXPECT_EQ(changed->detail, "the plan has 3 actions, but 4 are committed");

  Scene other = committed_to(3);
  other.robots()[0].committed[2].type = Action::Type::rotate;
  EXPECT_THAT(kinds_of(other.violations(CheckRules{})), ElementsAre(Kind::committed_changed));
}

TEST(Commitments, AreExecutedByRobotsWithoutAPlan) {
  Scene scene;
  Robot robot = robot_at(2, 5);
  robot.committed = PlanBuilder(0, robot).translate_to(6, 5).build().actions;
  scene.stand(robot);
  scene.stand(robot_at(6, 5.9));
  const auto violations = scene.violations(CheckRules{});
  ASSERT_THAT(kinds_of(violations), ElementsAre(Kind::robot_collision));
  EXPECT_NEAR(violations[0].t, 4.0, 1e-9);
}

TEST(Commitments, OfParkedRobotsEndWhereTheyRest) {
  Scene scene = committed_to(5);
  scene.robots()[0].goal.reset();
  EXPECT_THAT(scene.violations(CheckRules{}), IsEmpty());
  scene.robots()[0].committed.pop_back();
  EXPECT_THAT(kinds_of(scene.violations(CheckRules{})), ElementsAre(Kind::wrong_goal));
}

TEST(Commitments, OfTheRequestAreNotJudgedByTheSpeedOfTheRobot) {
  Scene scene = committed_to(2);
  scene.robots()[0].linear_speed = 0.9;
  scene.action(4).t_end += 2.0;
  scene.plans()[0].cost += 2.0;
  EXPECT_THAT(scene.violations(exactly()), IsEmpty());
  EXPECT_THAT(kinds_of(scene.violations(CheckRules{})), ElementsAre(Kind::speed));
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
