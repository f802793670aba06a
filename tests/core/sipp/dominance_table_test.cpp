#include "core/sipp/dominance_table.h"

#include <gtest/gtest.h>

#include "core/geometry/interval.h"

namespace fleetplan::core {
namespace {

constexpr Motion kMotion{0.4, 1.0, 0.5, 0.0};  // a radian takes 2 s
constexpr Motion kWaiting{0.4, 1.0, 0.5, 3.0};

DominanceTable in_intervals(std::size_t count, const Motion& motion, double slack = 0.0) {
  DominanceTable arrivals;
  arrivals.begin(motion, slack);
  arrivals.set_interval_count(count);
  return arrivals;
}

TEST(DominanceTable, MakeOthersNeedlessOnceTheyHaveTurned) {
  DominanceTable arrivals = in_intervals(1, kMotion);
  EXPECT_EQ(arrivals.needless_from(0, 0.0), kForever);
  arrivals.add(0, 10.0, 0.0);
  EXPECT_DOUBLE_EQ(arrivals.needless_from(0, 0.0), 10.0);
  EXPECT_DOUBLE_EQ(arrivals.needless_from(0, 1.5), 13.0);
  arrivals.add(0, 10.5, 1.5);
  EXPECT_DOUBLE_EQ(arrivals.needless_from(0, 1.5), 10.5);
  EXPECT_DOUBLE_EQ(arrivals.needless_from(0, 1.0), 11.5) << "the later one turns less";
}

TEST(DominanceTable, MakeOthersNeedlessOnlyAfterTheAddedWait) {
  DominanceTable arrivals = in_intervals(1, kWaiting);
  arrivals.add(0, 10.0, 0.0);
  EXPECT_DOUBLE_EQ(arrivals.needless_from(0, 0.0), 13.0) << "who passes on does without the wait";
  EXPECT_TRUE(arrivals.has(0, 10.0, 0.0));
  EXPECT_FALSE(arrivals.has(0, 10.0, 0.1));
  EXPECT_FALSE(arrivals.has(0, 10.1, 0.0));
}

TEST(DominanceTable, WithSlackMakeOthersNeedlessThatAreHardlyEarlier) {
  DominanceTable arrivals = in_intervals(1, kMotion, 0.25);
  arrivals.add(0, 10.0, 0.0);
  EXPECT_DOUBLE_EQ(arrivals.needless_from(0, 3.0), 9.75);
}

TEST(DominanceTable, StrikeOutThoseThatTheyDominate) {
  DominanceTable arrivals = in_intervals(1, kMotion);
  const int turned = arrivals.add(0, 10.0, 1.0);
  const int same = arrivals.add(0, 11.0, 0.0);
  const int earlier = arrivals.add(0, 9.0, 0.0);
  EXPECT_FALSE(arrivals.dominated(turned)) << "to turn there takes longer";
  EXPECT_TRUE(arrivals.dominated(same));
  EXPECT_FALSE(arrivals.has(0, 11.0, 0.0));
  const int earliest = arrivals.add(0, 8.0, 1.0);
  EXPECT_TRUE(arrivals.dominated(turned));
  EXPECT_FALSE(arrivals.dominated(earlier));
  EXPECT_FALSE(arrivals.dominated(earliest));
}

TEST(DominanceTable, OfOneIntervalAreNotThoseOfAnother) {
  DominanceTable arrivals = in_intervals(2, kMotion);
  const int later = arrivals.add(1, 10.0, 0.0);
  arrivals.add(0, 5.0, 0.0);
  EXPECT_FALSE(arrivals.dominated(later));
  EXPECT_DOUBLE_EQ(arrivals.needless_from(1, 0.0), 10.0);
  arrivals.set_interval_count(3);
  EXPECT_TRUE(arrivals.none_in(2));
  EXPECT_FALSE(arrivals.none_in(1));
}

TEST(DominanceTable, AreForgottenWithTheirIntervals) {
  DominanceTable arrivals = in_intervals(1, kMotion);
  arrivals.add(0, 5.0, 0.0);
  arrivals.begin(kMotion, 0.0);
  arrivals.set_interval_count(1);
  EXPECT_TRUE(arrivals.none_in(0));
}

}  // namespace
}  // namespace fleetplan::core
