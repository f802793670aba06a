#include "core/lns/neighbourhood.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/core/support/planning.h"

namespace fleetplan::core {
namespace {

using support::robot_at;
using testing::ElementsAre;
using testing::SizeIs;
using testing::UnorderedElementsAre;

/// Robot 0 goes round robot 1, which stands on its straight way; robot 2 passes near robot 0's goal; robot 3
/// is far from everybody, and robot 4 is parked.
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

  std::vector<std::size_t> around(std::size_t first, Neighbourhood kind, std::size_t size) {
    return Neighbourhoods(state, movers(), never).around(first, kind, size, random);
  }
};

TEST(Neighbourhoods, OfOneRobotAreThatRobot) {
  Hall p;
  for (std::size_t kind = 0; kind < kNeighbourhoods; ++kind) {
    EXPECT_THAT(p.around(2, static_cast<Neighbourhood>(kind), 1), ElementsAre(2));
  }
}

TEST(Neighbourhoods, HoldThoseInTheWay) {
  Hall p;
  EXPECT_THAT(p.around(0, Neighbourhood::conflicting, 4), ElementsAre(0, 1));
  EXPECT_THAT(p.around(3, Neighbourhood::conflicting, 4), ElementsAre(3)) << "nobody is in its way";
}

TEST(Neighbourhoods, HoldThoseThatARobotMeets) {
  Hall p;
  EXPECT_THAT(p.around(0, Neighbourhood::meeting, 3), UnorderedElementsAre(0, 1, 2)) << "robot 3 is far away";
}

TEST(Neighbourhoods, HoldThoseThatPassTheGoal) {
  Hall p;
  EXPECT_THAT(p.around(0, Neighbourhood::at_goal, 2), ElementsAre(0, 2));
}

TEST(Neighbourhoods, HoldEverybodyOnceAtMost) {
  Hall p;
  EXPECT_THAT(p.around(0, Neighbourhood::anybody, 16), UnorderedElementsAre(0, 1, 2, 3));
  EXPECT_THAT(p.around(0, Neighbourhood::meeting, 16), UnorderedElementsAre(0, 1, 2, 3));
  EXPECT_THAT(p.around(0, Neighbourhood::anybody, 2), SizeIs(2));
}

}  // namespace
}  // namespace fleetplan::core
