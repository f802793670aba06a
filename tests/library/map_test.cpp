#include <fleetplan/map.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <limits>
#include <stdexcept>

namespace fleetplan {
namespace TEST_FILE {

TEST(PublicMap, IsDrawnFromTheTopAndCountedFromTheBottom) {
  const Map map = Map::from_rows({"#..",  //
                                  ".G@"},
                                 0.5, {10.0, 20.0});
  EXPECT_EQ(map.columns(), 3);
  EXPECT_EQ(map.rows(), 2);
  EXPECT_TRUE(map.blocked(0, 1));
  EXPECT_TRUE(map.blocked(2, 0));
  EXPECT_FALSE(map.blocked(1, 0));
  EXPECT_EQ(map.center(2, 1), (Position{11.25, 20.75}));
}

TEST(PublicMap, TakesCellsRowByRowFromTheBottom) {
  const std::array<std::uint8_t, 6> cells{0, 100, 0, 0, 0, 1};
  const Map map = Map::from_cells(cells, 3, 2, 1.0);
  EXPECT_TRUE(map.blocked(1, 0));
  EXPECT_TRUE(map.blocked(2, 1));
  EXPECT_FALSE(map.blocked(0, 0));
  EXPECT_THROW(Map::from_cells(cells, 2, 2, 1.0), std::invalid_argument);
}

TEST(PublicMap, BlocksAndFreesCells) {
  Map map(2, 2, 1.0);
  map.block(1, 0);
  EXPECT_TRUE(map.blocked(1, 0));
  map.block(1, 0, false);
  EXPECT_FALSE(map.blocked(1, 0));
  EXPECT_TRUE(map.blocked(-1, 0)) << "outside";
  EXPECT_TRUE(map.blocked(0, 2)) << "outside";
  EXPECT_THROW(map.block(2, 0), std::out_of_range);
}

TEST(PublicMap, RejectsWhatIsNoMap) {
  EXPECT_THROW(Map(0, 1, 1.0), std::invalid_argument);
  EXPECT_THROW(Map(1, 1, 0.0), std::invalid_argument);
  EXPECT_THROW(Map(1, 1, std::numeric_limits<double>::quiet_NaN()), std::invalid_argument);
  EXPECT_THROW(Map(2'000'000, 1, 1.0), std::invalid_argument) << "wider than 1e6 m";
  EXPECT_THROW(Map(1, 1, 1.0, {2e9, 0.0}), std::invalid_argument);
  EXPECT_THROW(Map::from_rows({"..", "."}, 1.0), std::invalid_argument);
  EXPECT_THROW(Map::from_rows({"S"}, 1.0), std::invalid_argument);
  EXPECT_THROW(Map::from_rows({""}, 1.0), std::invalid_argument);
}

}  // namespace TEST_FILE
}  // namespace fleetplan
