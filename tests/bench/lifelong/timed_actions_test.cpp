#include "tests/bench/lifelong/timed_actions.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

namespace fleetplan::bench {
namespace TEST_FILE {

using core::Action;
using core::Pose;

constexpr double kRight = std::numbers::pi / 2.0;

/// Drives 4 m east in 4 s, waits 1 s, and turns to the north in 1 s.
Actions example() {
  const Pose origin{{0.0, 0.0}, 0.0};
  const Pose corner{{4.0, 0.0}, 0.0};
  const Pose turned{{4.0, 0.0}, kRight};
  return {{Action::Type::translate, 0.0, 4.0, origin, corner, {}},
          {Action::Type::wait, 4.0, 5.0, corner, corner, {}},
          {Action::Type::rotate, 5.0, 6.0, corner, turned, {}}};
}

TEST(TimedActions, LeadFromPoseToPose) {
  EXPECT_DOUBLE_EQ(pose_at(example(), 1.0, {}).position.x(), 1.0);
  EXPECT_DOUBLE_EQ(pose_at(example(), 5.5, {}).theta, kRight / 2.0);
  EXPECT_DOUBLE_EQ(pose_at(example(), 9.0, {}).theta, kRight);
  EXPECT_DOUBLE_EQ(pose_at({}, 9.0, {{7.0, 7.0}, 0.0}).position.x(), 7.0);
}

TEST(TimedActions, AreCutWhereTheRobotIs) {
  const CutActions parts = cut(example(), 5.25);
  ASSERT_EQ(parts.before.size(), 3u);
  ASSERT_EQ(parts.after.size(), 1u);
  EXPECT_EQ(parts.before.back().to.theta, parts.after.front().from.theta);
  EXPECT_DOUBLE_EQ(parts.after.front().from.theta, kRight / 4.0);
  EXPECT_EQ(cut(example(), 4.0).before.size(), 1u);
  EXPECT_EQ(cut(example(), 4.0).after.size(), 2u);
}

TEST(TimedActions, AreTheSameMotionAfterACutAndAWaitThatIsLeftOut) {
  CutActions parts = cut(example(), 1.5);
  parts.before.insert(parts.before.end(), parts.after.begin(), parts.after.end());
  ASSERT_EQ(parts.before.size(), 4u);
  EXPECT_TRUE(same_motion(parts.before, example()));
  parts.before.erase(parts.before.begin() + 2);
  EXPECT_TRUE(same_motion(parts.before, example()));
  EXPECT_FALSE(same_motion(shifted(example(), 0.5), example()));
  EXPECT_FALSE(same_motion(parts.after, example()));
}

TEST(TimedActions, ArePausedAtATime) {
  const Actions late = paused(example(), 1.0, 2.0);
  EXPECT_DOUBLE_EQ(pose_at(late, 2.5, {}).position.x(), 1.0);
  EXPECT_DOUBLE_EQ(pose_at(late, 4.0, {}).position.x(), 2.0);
  EXPECT_DOUBLE_EQ(late.back().t_end, 8.0);
  EXPECT_DOUBLE_EQ(moving_time(late, 0.0, std::numeric_limits<double>::infinity()), 5.0);
  EXPECT_DOUBLE_EQ(moving_time(late, 0.5, 3.5), 1.0);
}

TEST(TimedActions, AreFilledUpWithAWait) {
  const Actions filled = waiting_until(example(), 8.0, 0.0, {});
  ASSERT_EQ(filled.size(), 4u);
  EXPECT_EQ(filled.back().t_start, 6.0);
  EXPECT_EQ(filled.back().t_end, 8.0);
  EXPECT_EQ(waiting_until(example(), 3.0, 0.0, {}).size(), 3u);
  EXPECT_EQ(waiting_until({}, 3.0, 1.0, {{2.0, 2.0}, 0.0}).front().t_start, 1.0);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::bench
