#include "core/advance/timeline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/advance/inertia.h"
#include "core/advance/released.h"
#include "core/geometry/position.h"
#include "tests/core/advance/driving_fleet.h"

namespace fleetplan::core {
namespace TEST_FILE {

using Type = Action::Type;

constexpr double kQuarter = std::numbers::pi / 2.0;

Robot robot() {
  Robot robot = robot_at(at_x(1.0));
  robot.angular_speed = kQuarter;
  return robot;
}

/// 4 m east, a quarter turn, a wait, 2 m north: 4 s, 1 s, 2 s, 2 s.
std::vector<Action> corner() {
  const Pose start = at_x(1.0);
  const Pose bend = at_x(5.0);
  const Pose turned = at_x(5.0, kQuarter);
  const Pose end{{5.0, 3.0}, kQuarter};
  return {{Type::translate, 0.0, 4.0, start, bend},
          {Type::rotate, 4.0, 5.0, bend, turned},
          {Type::wait, 5.0, 7.0, turned, turned},
          {Type::translate, 7.0, 9.0, turned, end}};
}

void expect_pose(const Pose& pose, double x, double y, double theta) {
  EXPECT_NEAR(pose.position.x(), x, 1e-9);
  EXPECT_NEAR(pose.position.y(), y, 1e-9);
  EXPECT_NEAR(pose.theta, theta, 1e-9);
}

void expect_contiguous(const Remainder& rest) {
  Pose pose = rest.start;
  double t = 0.0;
  for (const Action& action : rest.actions) {
    EXPECT_EQ(action.t_start, t);
    EXPECT_EQ(action.from.position, pose.position);
    EXPECT_EQ(action.from.theta, pose.theta);
    EXPECT_GT(action.t_end, action.t_start);
    if (action.type == Type::translate) {
      const Position path = action.to.position - action.from.position;
      EXPECT_NEAR(std::atan2(path.y(), path.x()), action.from.theta, 1e-9);
      EXPECT_EQ(action.from.theta, action.to.theta);
    }
    pose = action.to;
    t = action.t_end;
  }
}

TEST(Timeline, ATranslationUnderWayKeepsItsEndAndItsSpeed) {
  const Remainder rest = remainder(robot(), corner(), 1.5);
  expect_contiguous(rest);
  expect_pose(rest.start, 2.5, 1.0, 0.0);
  ASSERT_EQ(rest.actions.size(), 4U);
  EXPECT_EQ(rest.actions[0].t_end, 2.5);
  EXPECT_EQ(rest.actions[3].t_end, 7.5);
}

TEST(Timeline, ARotationUnderWayIsInterpolatedTheShorterWay) {
  auto actions = corner();
  actions.resize(2);
  actions[1].from.theta = 3.0;
  actions[1].to.theta = -3.0;
  const Remainder rest = remainder(robot(), actions, 4.75);
  ASSERT_EQ(rest.actions.size(), 1U);
  const double turn = 2.0 * (std::numbers::pi - 3.0);
  expect_pose(rest.start, 5.0, 1.0, 3.0 + 0.75 * turn - 2.0 * std::numbers::pi);
  expect_contiguous(rest);
}

TEST(Timeline, NothingIsLeftAfterTheLastAction) {
  const Remainder rest = remainder(robot(), corner(), 9.0);
  expect_pose(rest.start, 5.0, 3.0, kQuarter);
  EXPECT_TRUE(rest.actions.empty());
  expect_pose(remainder(robot(), {}, 3.0).start, 1.0, 1.0, 0.0);
}

TEST(Timeline, AnActionThatEndsAtTheMomentIsDone) {
  const Remainder rest = remainder(robot(), corner(), 4.0 - 1e-12);
  ASSERT_EQ(rest.actions.size(), 3U);
  expect_contiguous(rest);
  EXPECT_EQ(rest.actions[0].type, Type::rotate);
}

TEST(Timeline, ActionsAreCutWhereTheyAreUnderWay) {
  const auto cut = stopped_by(corner(), 6.0);
  ASSERT_EQ(cut.size(), 3U);
  EXPECT_EQ(cut[2].t_end, 6.0);
  const auto in_a_move = stopped_by(corner(), 1.0);
  ASSERT_EQ(in_a_move.size(), 1U);
  expect_pose(in_a_move[0].to, 2.0, 1.0, 0.0);
  EXPECT_TRUE(stopped_by(corner(), 0.0).empty());
}

/// Ahead at speed, then on through a slow part, from rest to rest.
std::vector<Action> through_two_parts(const Inertia& inertia) {
  std::vector<Action> parts{{Type::translate, 0.0, 0.0, at_x(1.0), at_x(5.0)},
                            {Type::translate, 0.0, 0.0, at_x(5.0), at_x(6.0)}};
  parts[0].profile = SpeedProfile{0.0, 2.0, 0.0, inertia};
  parts[1].profile = SpeedProfile{0.0, 0.5, 0.0, inertia};
  return driven_from(parts, 0.0, 0.0);
}

TEST(Timeline, ARobotThatNeedsTimeToStopBrakesAsLateAsItCan) {
  for (const Inertia& inertia : std::vector<Inertia>{{1.0, 0.5}, {0.3, 2.0}, {0.0, 1.0}, {1.0, 0.0}}) {
    const std::vector<Action> chain = through_two_parts(inertia);
    const double end = chain.back().t_end;
    for (int k = 0; k <= 60; ++k) {
      const double t = end * k / 60;
      SCOPED_TRACE(testing::Message() << "stands at " << t << ", " << inertia.rise << ", " << inertia.fall);
      const std::vector<Action> stopped = stopped_by(chain, t);
      double farthest = 1.0;
      for (int i = 0; i <= 500; ++i) {
        const std::vector<Action> tried = braked(chain, end * i / 500);
        if (!tried.empty() && tried.back().t_end <= t) {
          farthest = std::max(farthest, tried.back().to.position.x());
        }
      }
      EXPECT_GE(stopped.empty() ? 1.0 : stopped.back().to.position.x(), farthest - 1e-12);
      if (stopped.empty()) continue;
      EXPECT_LE(stopped.back().t_end, t + 1e-9);
      EXPECT_EQ(stopped.back().profile->end, 0.0);
      for (const Action& action : stopped) EXPECT_TRUE(profile_fits(action));
    }
  }
}

/// A robot that begins to brake a little earlier may lose less way than a translation has, but takes less
/// time.
TEST(Timeline, OneThatStandsHardlyEarlierWaitsForWhatFollows) {
  constexpr double kWay = 2e-9;  // metres, in which it needs 9e-5 s
  const Inertia inertia{1.0, 1.0};
  Action crawl{Type::translate, 0.0, 0.0, at_x(1.0), at_x(1.0 + kWay)};
  crawl.profile = fastest_profile(kWay, 1.0, inertia);
  crawl.t_end = duration(*crawl.profile, kWay);
  const std::vector<Action> all{crawl, {Type::wait, crawl.t_end, 5.0, crawl.to, crawl.to}};
  const double earlier = 0.8 * crawl.t_end;
  const std::vector<Action> split = split_at(all, earlier);
  ASSERT_EQ(split.size(), 3U);
  EXPECT_NEAR(split[0].t_end, earlier, 1e-12);
  EXPECT_EQ(split[1].type, Type::wait);
  EXPECT_EQ(split[1].t_start, split[0].t_end);
  EXPECT_EQ(split[1].t_end, crawl.t_end);
  EXPECT_EQ(split[2].t_start, crawl.t_end);
  EXPECT_EQ(split[2].t_end, 5.0);
}

TEST(Timeline, ActionsThatOverlapInTimeFollowEachOther) {
  std::vector<Action> actions = corner();
  actions[1].t_start = 1.0;  // while the robot still drives
  actions[2].t_start = 2.0;
  const Remainder rest = remainder(robot(), actions, 3.0);
  ASSERT_EQ(rest.actions.size(), 4u);
  expect_contiguous(rest);
  EXPECT_EQ(rest.actions.back().t_end, 1.0 + 4.0 + 5.0 + 2.0);

  const auto late = measured_progress(robot(), actions, at_x(3.0), 3.0, 1e-6);
  ASSERT_TRUE(late);
  expect_contiguous(remainder_of_measured(robot(), actions, at_x(3.0), *late, 3.0));
}

/// Relative to its length, the rounding of a short action is far more than the rounding of a long action.
TEST(Timeline, ActionsThatBecomeLongerAreNoFasterThanTheRobot) {
  Robot fast = robot();
  fast.linear_speed = 1.0;
  fast.angular_speed = 2.0;
  const Pose start = at_x(1.0);
  const Pose bend = at_x(5.0);
  const Pose turned = at_x(5.0, 1e-6);
  const std::vector<Action> actions{{Type::translate, 0.0, 4.0, start, bend},
                                    {Type::rotate, 4.0, 4.0 + 0.499e-6, bend, turned},
                                    {Type::wait, 4.0 + 0.499e-6, 5.0, turned, turned}};
  for (const Pose& pose : {Pose{{3.0, 1.08}, 0.0}, Pose{{5.0, 1.0}, -0.05}}) {
    const auto progress = measured_progress(fast, actions, pose, 4.0, 0.1);
    ASSERT_TRUE(progress);
    const Remainder rest = remainder_of_measured(fast, actions, pose, *progress, 4.0);
    expect_contiguous(rest);
    for (const Action& action : rest.actions) {
      const double turn = std::abs(rotation_between(action.from.theta, action.to.theta));
      const double way = (action.to.position - action.from.position).norm();
      EXPECT_LE(turn, 2.0 * (action.t_end - action.t_start) + 1e-9);
      EXPECT_LE(way, (action.t_end - action.t_start) + 1e-9);
    }
  }
}

TEST(Timeline, AHoldDelaysTheRest) {
  Remainder rest = remainder(robot(), corner(), 1.0);
  hold(rest, 0.0, 30.0);
  expect_contiguous(rest);
  ASSERT_EQ(rest.actions.size(), 5U);
  EXPECT_EQ(rest.actions[0].type, Type::wait);
  EXPECT_EQ(rest.actions[0].t_end, 30.0);
  EXPECT_EQ(rest.actions[1].t_end, 33.0);
  EXPECT_EQ(rest.actions[4].t_end, 38.0);
}

TEST(Timeline, AHoldTakesPlaceDuringAWaitUnderWay) {
  Remainder shorter = remainder(robot(), corner(), 5.5);
  hold(shorter, 0.0, 0.5);
  expect_contiguous(shorter);
  ASSERT_EQ(shorter.actions.size(), 3U);
  EXPECT_EQ(shorter.actions[2].t_end, 3.5);
  Remainder longer = remainder(robot(), corner(), 5.5);
  hold(longer, 0.0, 10.0);
  expect_contiguous(longer);
  ASSERT_EQ(longer.actions.size(), 2U);
  EXPECT_EQ(longer.actions[1].t_start, 10.0);
  EXPECT_EQ(longer.actions[1].t_end, 12.0);
}

TEST(Timeline, AServiceGoesOnWhileTheRobotIsHeld) {
  const Pose here = at_x(1.0);
  const std::vector<Action> served{{Type::wait, 0.0, 8.0, here, here, 0},
                                   {Type::translate, 8.0, 10.0, here, at_x(3.0)}};
  Remainder rest{here, served};
  hold(rest, 0.0, 20.0);
  expect_contiguous(rest);
  ASSERT_EQ(rest.actions.size(), 3U);
  EXPECT_EQ(rest.actions[0].goal, 0U);
  EXPECT_EQ(rest.actions[0].t_end, 8.0);
  EXPECT_FALSE(rest.actions[1].goal);
  EXPECT_EQ(rest.actions[1].t_end, 20.0);
  EXPECT_EQ(rest.actions[2].t_end, 22.0);

  for (Action& action : rest.actions) {  // the service is late
    action.t_start += 5.0;
    action.t_end += 5.0;
  }
  rest.actions[0].t_start = 0.0;
  hold(rest, 0.0, 19.0);
  expect_contiguous(rest);
  ASSERT_EQ(rest.actions.size(), 3U) << "held once, not twice";
  EXPECT_EQ(rest.actions[0].t_end, 13.0);
  EXPECT_EQ(rest.actions[1].t_end, 19.0);
  EXPECT_EQ(rest.actions[2].t_end, 21.0);

  hold(rest, 0.0, 10.0);
  expect_contiguous(rest);
  ASSERT_EQ(rest.actions.size(), 3U) << "cut where the hold ends, and then it drives";
  EXPECT_EQ(rest.actions[0].t_end, 10.0);
  EXPECT_EQ(rest.actions[1].goal, 0U);
  EXPECT_EQ(rest.actions[1].t_end, 13.0);
  EXPECT_EQ(rest.actions[2].t_end, 15.0);
}

Remainder measured(const Pose& pose, double at) {
  const auto progress = measured_progress(robot(), corner(), pose, at, 0.1);
  EXPECT_TRUE(progress);
  Remainder rest = remainder_of_measured(robot(), corner(), pose, progress.value_or(TimedProgress{}), at);
  expect_contiguous(rest);
  return rest;
}

TEST(Timeline, APoseThatIsAsPlannedChangesNoTime) {
  const Remainder rest = measured(at_x(2.5), 1.5);
  const Remainder planned = remainder(robot(), corner(), 1.5);
  ASSERT_EQ(rest.actions.size(), planned.actions.size());
  for (std::size_t k = 0; k < rest.actions.size(); ++k) {
    EXPECT_NEAR(rest.actions[k].t_end, planned.actions[k].t_end, 1e-12);
  }
}

TEST(Timeline, ALateRobotDrivesStraightToTheEndOfItsActionAndTheRestIsLater) {
  const Remainder rest = measured({{2.0, 1.09}, 0.02}, 3.0);
  ASSERT_EQ(rest.actions.size(), 4U);
  const double left = std::hypot(3.0, 0.09);
  expect_pose(rest.start, 2.0, 1.09, std::atan2(-0.09, 3.0));
  EXPECT_NEAR(rest.actions[0].t_end, left, 1e-12);
  expect_pose(rest.actions[0].to, 5.0, 1.0, std::atan2(-0.09, 3.0));
  // The rotation is longer, at its planned speed.
  EXPECT_NEAR(rest.actions[1].t_end - left, 1.0 + std::atan2(0.09, 3.0) / kQuarter, 1e-12);
  EXPECT_NEAR(rest.actions[3].t_end - rest.actions[1].t_end, 4.0, 1e-12);
}

TEST(Timeline, ARobotMayStillBeInAnEarlierActionThanPlanned) {
  const Remainder driving = measured(at_x(3.0), 8.0);
  ASSERT_EQ(driving.actions.size(), 4U);
  EXPECT_EQ(driving.start.theta, 0.0);
  EXPECT_NEAR(driving.actions[3].t_end, 2.0 + 5.0, 1e-12);
  const Remainder turning = measured({{5.0, 1.0}, 0.5 * kQuarter}, 8.0);
  ASSERT_EQ(turning.actions.size(), 3U);
  EXPECT_NEAR(turning.actions[0].t_end, 0.5, 1e-12);
  EXPECT_NEAR(turning.actions[2].t_end, 4.5, 1e-12);
}

TEST(Timeline, ARobotThatIsEarlyWaitsForItsPlan) {
  const Remainder rest = measured(at_x(4.0), 1.0);
  ASSERT_EQ(rest.actions.size(), 5U);
  EXPECT_NEAR(rest.actions[0].t_end, 1.0, 1e-12);
  EXPECT_EQ(rest.actions[1].type, Type::wait);
  EXPECT_EQ(rest.actions[1].t_end, 3.0);
  EXPECT_EQ(rest.actions[4].t_end, 8.0);
}

TEST(Timeline, ATranslationAlongAnotherLineEndsInThePlannedHeading) {
  auto actions = corner();
  actions.resize(1);
  const Remainder rest = remainder_of_measured(robot(), actions, {{2.0, 0.95}, 0.0}, {0, 1.0}, 1.0);
  expect_contiguous(rest);
  ASSERT_EQ(rest.actions.size(), 2U);
  expect_pose(rest.actions[1].to, 5.0, 1.0, 0.0);
}

TEST(Timeline, BesideALineThatGoesOnAtSpeedARobotStandsAndTurnsToIt) {
  const auto chain = through_two_parts({1.0, 0.5});
  ASSERT_GT(chain[0].profile->end, 0.0);
  Robot braking = robot();
  braking.linear_acceleration = 1.0;
  braking.linear_deceleration = 2.0;
  const double at = 2.0;
  const Pose beside{pose_at(chain[0], at).position + Position(0.0, 0.05), 0.0};
  const Remainder rest = remainder_of_measured(braking, chain, beside, {0, at}, at, std::nullopt);
  expect_contiguous(rest);
  ASSERT_EQ(rest.actions.size(), 3U);
  EXPECT_EQ(rest.actions[0].profile->end, 0.0);
  EXPECT_EQ(rest.actions[1].type, Type::rotate);
  EXPECT_EQ(rest.actions[2].profile->start, 0.0);
  EXPECT_TRUE(profile_fits(rest.actions[0]) && profile_fits(rest.actions[2]));
  expect_pose(rest.actions[2].to, 6.0, 1.0, 0.0);
}

TEST(Timeline, ARobotThatStandsIsWhereItsPlanHasIt) {
  const Remainder rest = measured({{5.05, 1.0}, kQuarter - 0.05}, 6.0);
  expect_pose(rest.start, 5.0, 1.0, kQuarter);
  ASSERT_FALSE(rest.actions.empty());
  EXPECT_EQ(rest.actions[0].t_end, 1.0);
  EXPECT_TRUE(measured({{5.0, 3.05}, kQuarter}, 20.0).actions.empty());
}

TEST(Timeline, APoseBesideThePathIsNoProgress) {
  EXPECT_FALSE(measured_progress(robot(), corner(), {{2.0, 1.2}, 0.0}, 1.0, 0.1));
  EXPECT_FALSE(measured_progress(robot(), corner(), at_x(2.0, 0.5), 1.0, 0.1));
  EXPECT_FALSE(measured_progress(robot(), {}, at_x(1.2), 1.0, 0.1));
  // Not yet planned.
  EXPECT_FALSE(measured_progress(robot(), corner(), {{5.0, 2.0}, kQuarter}, 1.0, 0.1));
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
