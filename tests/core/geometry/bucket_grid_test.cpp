#include "core/geometry/bucket_grid.h"

#include <gtest/gtest.h>

#include <map>
#include <vector>

#include "tests/core/geometry/random_motion.h"
#include "tests/support/random_problem.h"

namespace fleetplan::core {
namespace TEST_FILE {

struct Visit {
  std::size_t bucket;
  double enter;
  double exit;
};

std::vector<Visit> visits(const BucketGrid& grid, const Position& from, const Position& to) {
  std::vector<Visit> all;
  grid.walk(from, to, [&](std::size_t bucket, double enter, double exit) {
    all.push_back({bucket, enter, exit});
    return true;
  });
  return all;
}

TEST(BucketGrid, DividesMapIntoSquares) {
  const BucketGrid grid(5.0, 2.5, 2.0);
  EXPECT_EQ(grid.count(), 6u) << "the last ones extend beyond the map";
  EXPECT_EQ(grid.at({0.1, 0.1}), 0u);
  EXPECT_EQ(grid.at({4.9, 0.1}), 2u);
  EXPECT_EQ(grid.at({4.9, 2.4}), 5u);
  EXPECT_EQ(grid.at({2.0, 2.0}), 4u) << "a border belongs to the bucket right of and above it";
  EXPECT_EQ(BucketGrid(0.5, 0.5, 2.0).count(), 1u);
}

TEST(BucketGrid, WalksAlongRowInBothDirections) {
  const BucketGrid grid(8.0, 8.0, 2.0);
  const auto right = visits(grid, {1, 1}, {7, 1});
  ASSERT_EQ(right.size(), 4u);
  EXPECT_EQ(right[1].bucket, 1u);
  EXPECT_DOUBLE_EQ(right[1].enter, 1.0 / 6.0);
  EXPECT_DOUBLE_EQ(right[1].exit, 0.5);
  const auto left = visits(grid, {7, 1}, {1, 1});
  ASSERT_EQ(left.size(), 4u);
  EXPECT_EQ(left[1].bucket, 2u);
  EXPECT_DOUBLE_EQ(left[1].enter, 1.0 / 6.0);
}

TEST(BucketGrid, VisitsOneBucketForPoint) {
  const auto one = visits(BucketGrid(8.0, 8.0, 2.0), {3, 3}, {3, 3});
  ASSERT_EQ(one.size(), 1u);
  EXPECT_EQ(one[0].bucket, 5u);
  EXPECT_EQ(one[0].enter, 0.0);
  EXPECT_EQ(one[0].exit, 1.0);
}

TEST(BucketGrid, StopsWalkWhenVisitReturnsFalse) {
  const BucketGrid grid(8.0, 8.0, 2.0);
  int count = 0;
  EXPECT_FALSE(grid.walk({1, 1}, {7, 7}, [&](std::size_t, double, double) { return ++count < 2; }));
  EXPECT_EQ(count, 2);
  EXPECT_TRUE(grid.walk({1, 1}, {7, 7}, [](std::size_t, double, double) { return true; }));
}

class RandomBuckets : public testing::Test {
 protected:
  static constexpr std::uint64_t kSeed = 17;

  /// A position on the map, often on the border of a bucket.
  Position place() {
    Position p(dice.between(0, kWidth), dice.between(0, kHeight));
    if (dice.chance(0.2)) p.x() = kSize * dice.below(8);
    if (dice.chance(0.2)) p.y() = kSize * dice.below(6);
    return p;
  }

  static constexpr double kSize = 1.25;
  static constexpr double kWidth = 9.7;
  static constexpr double kHeight = 7.3;
  support::Dice dice{kSeed};
  BucketGrid grid{kWidth, kHeight, kSize};
};

TEST_F(RandomBuckets, WalkCoversLine) {
  for (int k = 0; k < 3000; ++k) {
    SCOPED_TRACE(testing::Message() << "seed " << kSeed << ", line " << k);
    const Position from = place();
    Position to = place();
    if (dice.chance(0.1)) to.x() = from.x();
    if (dice.chance(0.1)) to.y() = from.y();
    const auto all = visits(grid, from, to);
    ASSERT_EQ(all.front().enter, 0.0);
    ASSERT_EQ(all.back().exit, 1.0);
    for (std::size_t i = 1; i < all.size(); ++i) ASSERT_EQ(all[i].enter, all[i - 1].exit);
    for (const Visit& visit : all) {
      ASSERT_LE(visit.enter, visit.exit);
      if (visit.exit - visit.enter < 1e-9) continue;  // a corner
      const Position middle = from + 0.5 * (visit.enter + visit.exit) * (to - from);
      ASSERT_EQ(grid.at(middle), visit.bucket) << "at " << middle.transpose();
    }
  }
}

TEST_F(RandomBuckets, CoverContainsEveryBucketWithinReach) {
  for (int k = 0; k < 600; ++k) {
    SCOPED_TRACE(testing::Message() << "seed " << kSeed << ", disk " << k);
    const Position from = place();
    const Position to = dice.chance(0.3) ? from : place();
    const double t_start = dice.between(0, 5);
    const double t_end = t_start + dice.between(0.1, 5);
    const MovingDisk disk(TimedSegment{{from, to}, t_start, t_end});
    const double reach = dice.between(0.1, 3.0);
    std::map<std::size_t, SafeInterval> covered;
    grid.cover(disk, reach, [&](std::size_t bucket, double t_begin, double t_last) {
      ASSERT_LE(t_begin, t_last);
      ASSERT_TRUE(covered.insert({bucket, {t_begin, t_last}}).second) << "visited twice";
    });
    for (int i = 0; i < 400; ++i) {
      const double t = dice.between(t_start, t_end);
      const Position near = disk.at(t) + dice.between(0, reach) * direction(dice.between(-4, 4));
      if (near.x() < 0 || near.x() > kWidth || near.y() < 0 || near.y() > kHeight) continue;
      const auto window = covered.find(grid.at(near));
      ASSERT_NE(window, covered.end()) << near.transpose();
      ASSERT_LE(window->second.begin, t);
      ASSERT_GE(window->second.end, t);
    }
  }
}

TEST_F(RandomBuckets, CoverExceedsReachByAtMostBucketDiagonal) {
  for (int k = 0; k < 600; ++k) {
    SCOPED_TRACE(testing::Message() << "seed " << kSeed << ", disk " << k);
    const MovingDisk disk(TimedSegment{{place(), place()}, 0.0, 1.0});
    const double reach = dice.between(0.1, 3.0);
    grid.cover(disk, reach, [&](std::size_t bucket, double, double) {
      const int columns = 8;
      const Position center(kSize * (static_cast<int>(bucket) % columns + 0.5),
                            kSize * (static_cast<int>(bucket) / columns + 0.5));
      const MovingDisk point(TimedSegment{{center, center}, 0.0, 1.0});
      ASSERT_LE(closest(disk, point), reach + 0.7072 * kSize + 1e-9);
    });
  }
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
