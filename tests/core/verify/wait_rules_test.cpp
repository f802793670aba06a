// Added waits: robots stand still, already turned, before they move.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "tests/core/verify/scene.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::PlanBuilder;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

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

}  // namespace TEST_FILE
}  // namespace fleetplan::core
