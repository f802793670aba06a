#include "core/execution/retime.h"

#include <gtest/gtest.h>

#include <string>

#include "core/execution/dependencies.h"
#include "tests/support/plan_builder.h"
#include "tests/support/step_limit.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::PlanBuilder;

/// `a` crosses the lane of `b`, which waits for a while before it moves.
class Retime : public testing::Test {
 protected:
  Retime() {
    for (const char* id : {"a", "b"}) robots_.push_back({id, 0.5, 1.0, 2.0, {}, Goal{}});
    robots_[0].start = {{-5, 0}, 0.0};
    robots_[1].start = {{0, -5}, 1.5707963267948966};
    plan(4.0);
  }

  void plan(double wait) {
    plans_ = {PlanBuilder(0, robots_[0]).translate_to(5, 0).build(),
              PlanBuilder(1, robots_[1]).wait(wait).translate_to(0, 5).build()};
    dependencies_ = make_dependencies(robots_, plans_, {{0.0, 0.0}, 0.1, 0.0}, StopCondition::never())->list;
  }

  std::vector<RetimedRobot> times(const std::vector<ObservedState>& states, const RetimeRules& rules) {
    return *retime(robots_, executed_actions(robots_, plans_), dependencies_, states, rules,
                   StopCondition::never());
  }

  std::vector<Robot> robots_;
  std::vector<RobotPlan> plans_;
  std::vector<Dependency> dependencies_;
};

TEST_F(Retime, WithoutDelaysGivesThePlannedTimes) {
  for (const double now : {0.0, 2.0, 4.0, 9.0, 20.0}) {
    const auto found = times({}, {now, 0.0});
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_NEAR(found[k].delay, 0.0, 1e-9);
      EXPECT_FALSE(found[k].because_of);
      EXPECT_EQ(found[k].first + found[k].ends.size(), plans_[k].actions.size());
      for (std::size_t n = 0; n < found[k].ends.size(); ++n) {
        EXPECT_NEAR(found[k].ends[n], plans_[k].actions[found[k].first + n].t_end, 1e-9);
      }
    }
  }
}

/// However many dependencies there are, the stop condition is asked soon, and sees nothing but more of them.
TEST_F(Retime, EndsWhileItReadsThatARobotDependsManyTimes) {
  const auto expected = times({}, {});
  dependencies_.resize(100'000, dependencies_.front());
  support::StepLimit limit(100);
  EXPECT_FALSE(
      retime(robots_, executed_actions(robots_, plans_), dependencies_, {}, {}, support::counted(limit)));
  EXPECT_LT(limit.late(), 10);
  const auto found = times({}, {});
  for (std::size_t k = 0; k < 2; ++k) EXPECT_EQ(found[k].ends, expected[k].ends);
}

TEST_F(Retime, AHeldRobotDelaysThoseThatWaitForIt) {
  // a is held for 7 s: it passes the crossing, 6 m from its start, at 13 s. b is there at 8 s.
  const auto found = times({{0, 0, 0.0, 1.0, 7.0}}, {});
  EXPECT_NEAR(found[0].delay, 7.0, 1e-9);
  EXPECT_EQ(found[0].because_of, 0U);
  EXPECT_FALSE(found[0].waits_for);
  EXPECT_NEAR(found[1].delay, 5.0, 1e-6);
  EXPECT_EQ(found[1].because_of, 0U);
  EXPECT_EQ(found[1].waits_for, 0U);
}

TEST_F(Retime, ADelayWithinTheSlackDelaysNobodyElse) {
  const auto found = times({{0, 0, 0.0, 1.0, 1.9}}, {});
  EXPECT_NEAR(found[0].delay, 1.9, 1e-9);
  EXPECT_NEAR(found[1].delay, 0.0, 1e-9);
  EXPECT_FALSE(found[1].because_of);
}

TEST_F(Retime, AWaitThatOnlyGaveWayAbsorbsDelays) {
  const auto found = times({{1, 0, 0.0, 1.0, 3.0}}, {2.0, 0.0});
  EXPECT_NEAR(found[1].delay, 1.0, 1e-9);  // held until 5 s, planned to leave at 4 s
}

TEST_F(Retime, AWaitBeforeAMoveDoesNot) {
  const auto found = times({{1, 0, 0.0, 1.0, 0.0}}, {3.0, 2.0});
  EXPECT_NEAR(found[1].delay, 1.0, 1e-9);  // it has stood for 0 of 4 s, of which it needs 2
}

TEST_F(Retime, ASlowRobotTakesLongerFromNowOn) {
  const auto found = times({{0, 0, 0.5, 0.5, 0.0}}, {5.0, 0.0});
  EXPECT_NEAR(found[0].delay, 5.0, 1e-9);
  EXPECT_EQ(found[0].because_of, 0U);
}

TEST_F(Retime, AServiceLastsAndBeginsNoEarlierThanItMay) {
  robots_[1].via = {Goal{{0, -5}, {}}};
  robots_[1].via[0].service = 1.0;
  robots_[1].via[0].not_before = 3.0;
  plan(4.0);
  plans_[1].actions[0].goal = 0;
  EXPECT_NEAR(times({{1, 0, 0.0, 1.0, 0.0}}, {2.0, 0.0})[1].delay, 0.0, 1e-9);
  EXPECT_NEAR(times({{1, 0, 0.0, 1.0, 0.0}}, {3.5, 0.0})[1].delay, 0.5, 1e-9);
}

TEST_F(Retime, AnAddedWaitMayBeLongerThanTheServiceAtItsEnd) {
  robots_[1].via = {Goal{{0, -5}, {}, 1.0, 3.0}};
  plan(4.0);
  plans_[1].actions[0].goal = 0;
  EXPECT_NEAR(times({}, {0.0, 2.5})[1].delay, 0.0, 1e-9);
  EXPECT_NEAR(times({{1, 0, 0.0, 1.0, 0.0}}, {3.0, 2.5})[1].delay, 1.5, 1e-9);
}

TEST_F(Retime, ARobotThatHasPassedItsGateGoesOn) {
  const auto found = times({{0, 0, 0.1, 1.0, 0.0}, {1, 1, 0.5, 1.0, 0.0}}, {9.0, 0.0});
  EXPECT_NEAR(found[1].delay, 0.0, 1e-9);
  EXPECT_NEAR(found[0].delay, 8.0, 1e-9);
}

/// `a` and `b` drive 18 m each at 2 m/s, in 12 s. They take 2 s and 2 m to start, 4 s and 4 m to stop. `b`
/// may not pass 9 m until `a` is at 9 m.
class RetimeHeavy : public testing::Test {
 protected:
  RetimeHeavy() {
    for (const double y : {0.0, 5.0}) {
      Robot robot{y > 0.0 ? "b" : "a", 0.5, 2.0, 2.0, {{0, y}, 0.0}, Goal{}};
      robot.linear_acceleration = 1.0;
      robot.linear_deceleration = 0.5;
      Action action{Action::Type::translate, 0.0, 12.0, robot.start, {{18, y}, 0.0}};
      action.profile = fastest_profile(18.0, 2.0, robot.linear_inertia());
      plans_.push_back({robots_.size(), 12.0, {action}});
      robots_.push_back(robot);
    }
  }

  std::vector<RetimedRobot> times(const std::vector<ObservedState>& states, double until, double now = 0.0) {
    return *retime(robots_, executed_actions(robots_, plans_), {{{1, 0, 0.5}, {0, 0, until}, 0.0}}, states,
                   {now, 0.0}, StopCondition::never());
  }

  std::vector<Robot> robots_;
  std::vector<RobotPlan> plans_;
};

TEST_F(RetimeHeavy, WithoutDelaysAndWithOpenGatesGivesThePlannedTimes) {
  for (const double now : {0.0, 1.0, 5.0, 10.0, 12.0, 15.0}) {
    const auto found = times({}, 0.2, now);
    EXPECT_NEAR(found[0].delay, 0.0, 1e-9) << now;
    EXPECT_NEAR(found[1].delay, 0.0, 1e-9) << now;
  }
}

TEST_F(RetimeHeavy, AFactorIsOnTheCruiseSpeed) {
  EXPECT_NEAR(times({{0, 0, 0.0, 0.5, 0.0}}, 0.2)[0].ends.back(), 18.0 + 0.5 + 1.0, 1e-9);
}

TEST_F(RetimeHeavy, AHeldRobotGoesOnFromRest) {
  // At 5 s it is at 8 m, and stands there until 7 s.
  EXPECT_NEAR(times({{0, 0, 8.0 / 18, 1.0, 2.0}}, 0.2, 5.0)[0].ends.back(), 7.0 + 5.0 + 1.0 + 2.0, 1e-9);
  EXPECT_NEAR(times({{0, 0, 8.0 / 18, 1.0, 0.0}}, 0.2, 5.0)[0].ends.back(), 12.0, 1e-9);
}

TEST_F(RetimeHeavy, AStopAtAGateCostsBrakingAndStarting) {
  // a is held for 10 s, and at 9 m at 15.5 s.
  const auto found = times({{0, 0, 0.0, 1.0, 10.0}}, 0.5);
  EXPECT_NEAR(found[1].ends.back(), 15.5 + 7.5, 1e-9);
  EXPECT_EQ(found[1].waits_for, 0U);
  EXPECT_EQ(found[1].because_of, 0U);
}

TEST_F(RetimeHeavy, AGateThatOpensWhileTheRobotBrakesCostsLess) {
  const auto found = times({}, 0.5);  // a is at 9 m at 5.5 s; b has braked to 1 m/s, at 8 m
  EXPECT_NEAR(found[0].delay, 0.0, 1e-9);
  EXPECT_NEAR(found[1].ends.back(), 5.5 + 1.0 + 2.25 + 4.0, 1e-9);
  EXPECT_EQ(found[1].waits_for, 0U);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
