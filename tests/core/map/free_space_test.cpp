#include "core/map/free_space.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "tests/core/map/distances.h"
#include "tests/support/ascii_map.h"
#include "tests/support/random_problem.h"

namespace fleetplan::core {
namespace TEST_FILE {

TEST(FreeSpace, AllowStepsThatDiskMaySweep) {
  const std::uint64_t seed = 5;
  support::Dice dice(seed);
  for (int map = 0; map < 24; ++map) {
    SCOPED_TRACE(testing::Message() << "seed " << seed << ", map " << map);
    const OccupancyGrid grid = support::random_map(dice);
    const LineOfSight sight(grid, StopCondition::never());
    const Lattice lattice(grid, 4 << (map % 4));
    const double radius = grid.resolution() * dice.between(0.05, 1.5);
    FreeSpace space(lattice, sight, radius);
    for (int k = 0; k < 20; ++k) {
      const int v = dice.below(lattice.vertex_count());
      const std::uint32_t mask = space.steps_from(v);
      ASSERT_EQ(space.steps_from(v), mask) << "the cached answer";
      for (std::size_t i = 0; i < lattice.steps().size(); ++i) {
        const auto [columns, rows] = lattice.steps()[i];
        const Position to =
            lattice.position(v) + grid.resolution() * Position(static_cast<double>(columns), rows);
        const double distance = obstacle_distance_of(grid, lattice.position(v), to);
        if (std::abs(distance - radius) < 1e-8) continue;
        ASSERT_EQ((mask >> i & 1u) != 0, distance > radius) << "vertex " << v << ", step " << i;
      }
    }
  }
}

TEST(FreeSpace, DoNotCutCorners) {
  const OccupancyGrid grid = support::ascii_map({"..",  //
                                                 ".#"});
  const LineOfSight sight(grid, StopCondition::never());
  const Lattice lattice(grid, 8);
  FreeSpace space(lattice, sight, 0.3);
  const int bottom_left = lattice.vertex(0, 0);
  EXPECT_EQ(std::popcount(space.steps_from(bottom_left)), 1) << "only straight up";
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
