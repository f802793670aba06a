#include "core/lns/neighbourhood.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/core/support/planning.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::robot_at;
using testing::ElementsAre;
using testing::SizeIs;
using testing::UnorderedElementsAre;

/// Robot 0 passes around robot 1, which stands on its straight path; robot 2 passes near robot 0's goal;
/// robot 3 is far from all others, and robot 4 is parked.
struct Hall : Planning {
  Hall()
      : Planning(
            OccupancyGrid(21, 21, 1.0),
            {robot_at(0.5, 2.5).to(8.5, 2.5), robot_at(4.5, 2.5).to(4.5, 2.5),
             robot_at(8.5, 0.5).to(10.5, 2.5), robot_at(18.5, 20.5).to(20.5, 20.5), robot_at(0.5, 20.5)}) {
    state.follow(0, through({{0.5, 2.5}, {4.5, 4.5}, {8.5, 2.5}}));
    state.follow(1, through({{4.5, 2.5}}));
    state.follow(2, through({{8.5, 0.5}, {10.5, 2.5}}));
    state.follow(3, through({{18.5, 20.5}, {20.5, 20.5}}));
    state.stay_at_start(4);
  }

  std::vector<std::size_t> select(std::size_t first, Neighbourhood kind, std::size_t size) {
    return NeighbourhoodSelection(state, movers(), never).select(first, kind, size, random);
  }
};

TEST(NeighbourhoodSelection, OfSizeOneIsTheFirstRobot) {
  Hall p;
  for (std::size_t kind = 0; kind < kNeighbourhoods; ++kind) {
    EXPECT_THAT(p.select(2, static_cast<Neighbourhood>(kind), 1), ElementsAre(2));
  }
}

TEST(NeighbourhoodSelection, ContainsConflictingRobots) {
  Hall p;
  EXPECT_THAT(p.select(0, Neighbourhood::conflicting, 4), ElementsAre(0, 1));
  EXPECT_THAT(p.select(3, Neighbourhood::conflicting, 4), ElementsAre(3)) << "no robot conflicts with it";
}

TEST(NeighbourhoodSelection, ContainsRobotsNearbyAtSomeTime) {
  Hall p;
  EXPECT_THAT(p.select(0, Neighbourhood::nearest, 3), UnorderedElementsAre(0, 1, 2)) << "robot 3 is far away";
}

TEST(NeighbourhoodSelection, ContainsRobotsThatPassTheGoal) {
  Hall p;
  EXPECT_THAT(p.select(0, Neighbourhood::at_goal, 2), ElementsAre(0, 2));
}

TEST(NeighbourhoodSelection, ContainsNoRobotTwice) {
  Hall p;
  EXPECT_THAT(p.select(0, Neighbourhood::random, 16), UnorderedElementsAre(0, 1, 2, 3));
  EXPECT_THAT(p.select(0, Neighbourhood::nearest, 16), UnorderedElementsAre(0, 1, 2, 3));
  EXPECT_THAT(p.select(0, Neighbourhood::random, 2), SizeIs(2));
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
