// Plans have to begin with the committed actions.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/verify/scene.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::PlanBuilder;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

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
