#include "core/sipp/dominance_table.h"

#include <gtest/gtest.h>

#include "core/geometry/interval.h"

namespace fleetplan::core {
namespace {

constexpr Motion kMotion{0.4, 1.0, 0.5, 0.0};  // a radian takes 2 s
constexpr Motion kWaiting{0.4, 1.0, 0.5, 3.0};

DominanceTable in_intervals(std::size_t count, const Motion& motion, double slack = 0.0) {
  DominanceTable arrivals;
  arrivals.reset(motion, slack);
  arrivals.set_interval_count(count);
  return arrivals;
}

TEST(DominanceTable, MakeOthersNeedlessOnceTheyHaveTurned) {
  DominanceTable arrivals = in_intervals(1, kMotion);
  EXPECT_EQ(arrivals.dominated_from(0, 0.0), kForever);
  arrivals.add(0, 10.0, 0.0);
  EXPECT_DOUBLE_EQ(arrivals.dominated_from(0, 0.0), 10.0);
  EXPECT_DOUBLE_EQ(arrivals.dominated_from(0, 1.5), 13.0);
  arrivals.add(0, 10.5, 1.5);
  EXPECT_DOUBLE_EQ(arrivals.dominated_from(0, 1.5), 10.5);
  EXPECT_DOUBLE_EQ(arrivals.dominated_from(0, 1.0), 11.5) << "the later one turns less";
}

TEST(DominanceTable, MakeOthersNeedlessOnlyAfterTheAddedWait) {
  DominanceTable arrivals = in_intervals(1, kWaiting);
  arrivals.add(0, 10.0, 0.0);
  EXPECT_DOUBLE_EQ(arrivals.dominated_from(0, 0.0), 13.0) << "who passes on does without the wait";
  EXPECT_TRUE(arrivals.contains(0, 10.0, 0.0));
  EXPECT_FALSE(arrivals.contains(0, 10.0, 0.1));
  EXPECT_FALSE(arrivals.contains(0, 10.1, 0.0));
}

TEST(DominanceTable, WithSlackMakeOthersNeedlessThatAreHardlyEarlier) {
  DominanceTable arrivals = in_intervals(1, kMotion, 0.25);
  arrivals.add(0, 10.0, 0.0);
  EXPECT_DOUBLE_EQ(arrivals.dominated_from(0, 3.0), 9.75);
}

TEST(DominanceTable, StrikeOutThoseThatTheyDominate) {
  DominanceTable arrivals = in_intervals(1, kMotion);
  const ArrivalId turned = arrivals.add(0, 10.0, 1.0);
  const ArrivalId same = arrivals.add(0, 11.0, 0.0);
  const ArrivalId earlier = arrivals.add(0, 9.0, 0.0);
  EXPECT_FALSE(arrivals.is_dominated(turned)) << "to turn there takes longer";
  EXPECT_TRUE(arrivals.is_dominated(same));
  EXPECT_FALSE(arrivals.contains(0, 11.0, 0.0));
  const ArrivalId earliest = arrivals.add(0, 8.0, 1.0);
  EXPECT_TRUE(arrivals.is_dominated(turned));
  EXPECT_FALSE(arrivals.is_dominated(earlier));
  EXPECT_FALSE(arrivals.is_dominated(earliest));
}

TEST(DominanceTable, OfOneIntervalAreNotThoseOfAnother) {
  DominanceTable arrivals = in_intervals(2, kMotion);
  const ArrivalId later = arrivals.add(1, 10.0, 0.0);
  arrivals.add(0, 5.0, 0.0);
  EXPECT_FALSE(arrivals.is_dominated(later));
  EXPECT_DOUBLE_EQ(arrivals.dominated_from(1, 0.0), 10.0);
  arrivals.set_interval_count(3);
  EXPECT_TRUE(arrivals.empty(2));
  EXPECT_FALSE(arrivals.empty(1));
}

TEST(DominanceTable, AreForgottenWithTheirIntervals) {
  DominanceTable arrivals = in_intervals(1, kMotion);
  arrivals.add(0, 5.0, 0.0);
  arrivals.reset(kMotion, 0.0);
  arrivals.set_interval_count(1);
  EXPECT_TRUE(arrivals.empty(0));
}

}  // namespace
}  // namespace fleetplan::core
