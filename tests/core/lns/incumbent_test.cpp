#include "core/lns/incumbent.h"

#include <gtest/gtest.h>

#include "tests/core/support/planning.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::robot_at;

/// Two robots that cross the map side by side.
struct TwoRows : Planning {
  TwoRows()
      : Planning(OccupancyGrid(9, 9, 1.0),
                 {robot_at(0.5, 2.5).to(8.5, 2.5), robot_at(0.5, 6.5).to(8.5, 6.5)}) {
    reservations.follow(0, row(2.5, 10.0));
    reservations.follow(1, row(6.5, 10.0));
  }

  static Trajectory row(double y, double departure) { return through({{0.5, y}, {8.5, y}}, departure); }
};

TEST(BestPlan, IsTheIncumbentWhileItGetsBetter) {
  TwoRows p;
  Incumbent incumbent(p.state, p.movers());
  BestPlan best(incumbent);
  best.replace(0, TwoRows::row(2.5, 4.0));
  EXPECT_TRUE(best.changed(6.0));
  EXPECT_TRUE(best.differences().empty());
  best.restore();
  EXPECT_EQ(incumbent.cost(0), TwoRows::row(2.5, 4.0).cost);
}

TEST(BestPlan, IsRestoredAfterLosses) {
  TwoRows p;
  Incumbent incumbent(p.state, p.movers());
  const double first = incumbent.cost(0);
  BestPlan best(incumbent);
  best.replace(0, TwoRows::row(2.5, 12.0));
  EXPECT_FALSE(best.changed(-2.0));
  best.replace(0, TwoRows::row(2.5, 11.0));
  EXPECT_FALSE(best.changed(1.0)) << "still worse than at first";
  best.replace(1, TwoRows::row(6.5, 10.5));
  EXPECT_FALSE(best.changed(-0.5));
  EXPECT_EQ(best.differences().size(), 2U);
  best.restore();
  EXPECT_EQ(incumbent.cost(0), first);
  EXPECT_EQ(incumbent.cost(1), first);
}

TEST(BestPlan, MayBeReachedThroughLosses) {
  TwoRows p;
  Incumbent incumbent(p.state, p.movers());
  BestPlan best(incumbent);
  best.replace(0, TwoRows::row(2.5, 11.0));
  EXPECT_FALSE(best.changed(-1.0));
  best.replace(1, TwoRows::row(6.5, 9.0));
  EXPECT_FALSE(best.changed(1.0)) << "as good as before";
  best.replace(1, TwoRows::row(6.5, 8.0));
  EXPECT_TRUE(best.changed(1.0));
  best.restore();
  EXPECT_EQ(incumbent.cost(0), TwoRows::row(2.5, 11.0).cost);
  EXPECT_EQ(incumbent.cost(1), TwoRows::row(6.5, 8.0).cost);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
