// Robots pass the same place with a margin of time between them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/core/verify/scene.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::PlanBuilder;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

CheckRules margin_of(double seconds) {
  CheckRules rules;
  rules.interval_margin = seconds;
  return rules;
}

/// Two robots cross at (10, 10); the second one goes `delay` seconds later than the first.
Scene crossing(double delay) {
  Scene scene;
  scene.add(robot_at(4, 10), [](PlanBuilder& plan) { plan.wait(10).translate_to(16, 10); });
  scene.add(robot_at(10, 4, 1.5707963267948966),
            [=](PlanBuilder& plan) { plan.wait(10 + delay).translate_to(10, 16); });
  return scene;
}

TEST(IntervalMargin, IsTheTimeByWhichRobotsMayBeEarlyOrLate) {
  // Centres of robots that cross at a right angle keep 1 m if they are sqrt(2) s apart.
  EXPECT_THAT(crossing(2.0).violations(margin_of(0)), IsEmpty());
  EXPECT_THAT(crossing(2.0).violations(margin_of(0.58)), IsEmpty());
  const auto violations = crossing(2.0).violations(margin_of(0.6));
  ASSERT_THAT(kinds_of(violations), ElementsAre(Kind::margin));
  EXPECT_THAT(violations[0].robots, ElementsAre(0, 1));
  EXPECT_NEAR(violations[0].distance, 1.4 / std::sqrt(2.0), 1e-9);
  EXPECT_DOUBLE_EQ(violations[0].required, 1.0);
  EXPECT_THAT(violations[0].detail, HasSubstr("but the interval margin is 0.6 s"));
}

TEST(IntervalMargin, IsNotAskedOfAStayAtTheStart) {
  // The robot leaves its place 1.5 s before the other one arrives there.
  Scene scene;
  scene.add(robot_at(5, 5, 1.5707963267948966), [](PlanBuilder& plan) { plan.wait(3).translate_to(5, 15); });
  scene.add(robot_at(0.5, 5), [](PlanBuilder& plan) { plan.wait(1.5).translate_to(15, 5); });
  EXPECT_THAT(scene.violations(margin_of(0)), IsEmpty());
  EXPECT_EQ(scene.violations(margin_of(5)).size(), 1U);  // once it drives, the other one follows too soon
  Scene stays;
  stays.stand(robot_at(5, 6));
  stays.add(robot_at(0.5, 5), [](PlanBuilder& plan) { plan.translate_to(15, 5); });
  EXPECT_THAT(stays.violations(margin_of(50)), IsEmpty());
}

TEST(IntervalMargin, IsNotAskedAmongCommittedMotions) {
  Scene scene = crossing(2.0);
  for (std::size_t i : {0U, 1U}) scene.robots()[i].committed = scene.plans()[i].actions;
  EXPECT_THAT(scene.violations(margin_of(5)), IsEmpty());
  scene.robots()[1].committed.clear();
  EXPECT_THAT(kinds_of(scene.violations(margin_of(5))), ElementsAre(Kind::margin));
}

TEST(IntervalMargin, IsAskedOfAStayAtTheGoal) {
  // The first robot comes to rest at t = 12 where the second one passed at t = 8.
  Scene scene;
  scene.add(robot_at(4, 10), [](PlanBuilder& plan) { plan.wait(6).translate_to(10, 10); });
  scene.add(robot_at(10, 4, 1.5707963267948966),
            [](PlanBuilder& plan) { plan.wait(2).translate_to(10, 16); });
  EXPECT_THAT(scene.violations(margin_of(2.5)), IsEmpty());
  EXPECT_EQ(scene.violations(margin_of(3)).size(), 1U);
  EXPECT_EQ(scene.violations(margin_of(60)).size(), 1U);
}

TEST(IntervalMargin, AddsNothingToACollision) {
  EXPECT_THAT(kinds_of(crossing(0.5).violations(margin_of(5))), ElementsAre(Kind::robot_collision));
}

TEST(IntervalMargin, IsNotAskedOfUnavoidableCollisions) {
  Scene scene;
  Robot committed = robot_at(2, 10);
  committed.committed = support::PlanBuilder(0, committed).translate_to(18, 10).build().actions;
  scene.stand(committed);
  scene.stand(robot_at(10, 10));
  CheckRules rules = margin_of(1);
  rules.exempt = {UnavoidableCollision{1, 0, {}, 8.0}};
  EXPECT_THAT(scene.violations(rules), IsEmpty());
  rules.exempt = {UnavoidableCollision{1, 0, {}, 3.0}};
  EXPECT_EQ(scene.violations(rules).size(), 1U);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
