#include "core/map/occupancy_grid.h"

#include <gtest/gtest.h>

#include "tests/support/ascii_map.h"

namespace fleetplan::core {
namespace TEST_FILE {

TEST(OccupancyGrid, CountsRowsFromTheBottom) {
  const OccupancyGrid grid = support::ascii_map({"#..",  //
                                                 "..#"});
  EXPECT_TRUE(grid.blocked({0, 1}));
  EXPECT_TRUE(grid.blocked({2, 0}));
  EXPECT_FALSE(grid.blocked({0, 0}));
  EXPECT_FALSE(grid.blocked({2, 1}));
}

TEST(OccupancyGrid, IsBlockedOutside) {
  const OccupancyGrid grid(3, 2, 1.0);
  for (const Cell cell : {Cell{-1, 0}, Cell{3, 0}, Cell{0, -1}, Cell{0, 2}}) {
    EXPECT_FALSE(grid.inside(cell));
    EXPECT_TRUE(grid.blocked(cell));
  }
}

TEST(OccupancyGrid, MeasuresInMetres) {
  const OccupancyGrid grid(8, 4, 0.25);
  EXPECT_EQ(grid.width(), 2.0);
  EXPECT_EQ(grid.height(), 1.0);
  EXPECT_EQ(grid.cell_count(), 32);
  EXPECT_EQ(grid.center({0, 0}), Position(0.125, 0.125));
  EXPECT_EQ(grid.center({7, 3}), Position(1.875, 0.875));
}

TEST(OccupancyGrid, BorderBelongsToCellOnRightOrAbove) {
  const OccupancyGrid grid(8, 4, 0.25);
  EXPECT_EQ(grid.cell_at({0.0, 0.0}), (Cell{0, 0}));
  EXPECT_EQ(grid.cell_at({0.25, 0.5}), (Cell{1, 2}));
  EXPECT_EQ(grid.cell_at({0.2499, 0.4999}), (Cell{0, 1}));
  EXPECT_EQ(grid.cell_at({-0.001, 1.0}), (Cell{-1, 4}));
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
