#include "core/model/trajectory.h"

#include <gtest/gtest.h>

namespace fleetplan::core {
namespace TEST_FILE {

/// Expects segments from t = 0 to kForever without gaps or jumps.
void expect_contiguous(const std::vector<TimedSegment>& segments) {
  ASSERT_FALSE(segments.empty());
  EXPECT_EQ(segments.front().t_start, 0.0);
  EXPECT_EQ(segments.back().t_end, kForever);
  EXPECT_EQ(segments.back().path.from, segments.back().path.to);
  for (std::size_t i = 1; i < segments.size(); ++i) {
    EXPECT_EQ(segments[i].t_start, segments[i - 1].t_end);
    EXPECT_EQ(segments[i].path.from, segments[i - 1].path.to);
  }
  for (const TimedSegment& segment : segments) EXPECT_LT(segment.t_start, segment.t_end);
}

TEST(TimedSegments, AreOneEndlessWaitForARobotAtRest) {
  const auto segments = timed_segments({{1, 2}, {}, 0.0});
  ASSERT_EQ(segments.size(), 1u);
  expect_contiguous(segments);
  EXPECT_EQ(segments[0].path.from, Position(1, 2));
}

TEST(TimedSegments, FillTheGapsBetweenMovesWithWaits) {
  const Trajectory trajectory{{0, 0}, {{{{{0, 0}, {2, 0}}, 1.0, 3.0}}, {{{{2, 0}, {2, 1}}, 4.5, 5.5}}}, 7.0};
  const auto segments = timed_segments(trajectory);
  expect_contiguous(segments);
  ASSERT_EQ(segments.size(), 5u);
  EXPECT_EQ(segments[0].t_end, 1.0);
  EXPECT_EQ(segments[2].path.from, Position(2, 0));
  EXPECT_EQ(segments[2].path.to, Position(2, 0));
  EXPECT_EQ(segments[2].t_end, 4.5);
  EXPECT_EQ(segments[4].path.from, Position(2, 1));
}

TEST(TimedSegments, HaveNoWaitBetweenContiguousMoves) {
  const Trajectory trajectory{{0, 0}, {{{{{0, 0}, {2, 0}}, 0.0, 2.0}}, {{{{2, 0}, {2, 1}}, 2.0, 3.0}}}, 3.0};
  const auto segments = timed_segments(trajectory);
  expect_contiguous(segments);
  EXPECT_EQ(segments.size(), 3u);
}

TEST(Trajectory, EndsWhereItsLastMoveEnds) {
  EXPECT_EQ((Trajectory{{1, 2}, {}, 0.0}.end()), Position(1, 2));
  EXPECT_EQ((Trajectory{{0, 0}, {{{{{0, 0}, {2, 1}}, 0.0, 2.0}}}, 2.0}.end()), Position(2, 1));
}

TEST(TimedSegment, HasTheVelocityOfItsMotion) {
  EXPECT_EQ((TimedSegment{{{0, 0}, {4, 2}}, 1.0, 3.0}.velocity()), Position(2, 1));
  EXPECT_EQ((TimedSegment{{{1, 1}, {1, 1}}, 1.0, kForever}.velocity()), Position(0, 0));
  EXPECT_EQ((TimedSegment{{{1, 1}, {1, 1}}, 1.0, 1.0}.velocity()), Position(0, 0)) << "no 0/0";
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
