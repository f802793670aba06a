#include <gtest/gtest.h>

#include "core/geometry/segment.h"
#include "core/sipp/search_state.h"

namespace fleetplan::core {
namespace TEST_FILE {

constexpr Body kBody{.radius = 0.4, .linear_speed = 1.0, .angular_speed = 0.5};  // a radian takes 2 s
constexpr Body kBodyWithWait{
    .radius = 0.4, .linear_speed = 1.0, .angular_speed = 0.5, .wait_before_move = 3.0};

DominanceTable table_of(std::size_t count, const Body& body, double slack = 0.0) {
  DominanceTable table;
  table.reset(body, slack);
  table.set_interval_count(count);
  return table;
}

TEST(DominanceTable, DominatesFromArrivalPlusRotation) {
  DominanceTable table = table_of(1, kBody);
  EXPECT_EQ(table.dominated_from(0, 0.0), kForever);
  table.add(0, 10.0, 0.0);
  EXPECT_DOUBLE_EQ(table.dominated_from(0, 0.0), 10.0);
  EXPECT_DOUBLE_EQ(table.dominated_from(0, 1.5), 13.0);
  table.add(0, 10.5, 1.5);
  EXPECT_DOUBLE_EQ(table.dominated_from(0, 1.5), 10.5);
  EXPECT_DOUBLE_EQ(table.dominated_from(0, 1.0), 11.5) << "the later arrival turns less";
}

TEST(DominanceTable, DominatesOnlyAfterAddedWait) {
  DominanceTable table = table_of(1, kBodyWithWait);
  table.add(0, 10.0, 0.0);
  EXPECT_DOUBLE_EQ(table.dominated_from(0, 0.0), 13.0) << "an arrival that continues straight needs no wait";
  EXPECT_TRUE(table.contains(0, 10.0, 0.0));
  EXPECT_FALSE(table.contains(0, 10.0, 0.1));
  EXPECT_FALSE(table.contains(0, 10.1, 0.0));
}

TEST(DominanceTable, DominatesSlightlyEarlierArrivalsWithinSlack) {
  DominanceTable table = table_of(1, kBody, 0.25);
  table.add(0, 10.0, 0.0);
  EXPECT_DOUBLE_EQ(table.dominated_from(0, 3.0), 9.75);
}

TEST(DominanceTable, AddRemovesDominatedArrivals) {
  DominanceTable table = table_of(1, kBody);
  const ArrivalId turned = table.add(0, 10.0, 1.0);
  const ArrivalId same = table.add(0, 11.0, 0.0);
  const ArrivalId earlier = table.add(0, 9.0, 0.0);
  EXPECT_FALSE(table.is_dominated(turned)) << "the rotation takes longer";
  EXPECT_TRUE(table.is_dominated(same));
  EXPECT_FALSE(table.contains(0, 11.0, 0.0));
  const ArrivalId earliest = table.add(0, 8.0, 1.0);
  EXPECT_TRUE(table.is_dominated(turned));
  EXPECT_FALSE(table.is_dominated(earlier));
  EXPECT_FALSE(table.is_dominated(earliest));
}

TEST(DominanceTable, KeepsIntervalsApart) {
  DominanceTable table = table_of(2, kBody);
  const ArrivalId later = table.add(1, 10.0, 0.0);
  table.add(0, 5.0, 0.0);
  EXPECT_FALSE(table.is_dominated(later));
  EXPECT_DOUBLE_EQ(table.dominated_from(1, 0.0), 10.0);
  table.set_interval_count(3);
  EXPECT_TRUE(table.empty(2));
  EXPECT_FALSE(table.empty(1));
}

TEST(DominanceTable, ResetRemovesAllArrivals) {
  DominanceTable table = table_of(1, kBody);
  table.add(0, 5.0, 0.0);
  table.reset(kBody, 0.0);
  table.set_interval_count(1);
  EXPECT_TRUE(table.empty(0));
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
