#include "core/fleet/static_ways.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tests/core/support/planning.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::robot_at;
using Robots = std::vector<std::size_t>;

constexpr std::int64_t kMany = 100'000;

TEST(StaticWays, FindsAGoalAtTheStartReachable) {
  Planning p(support::ascii_map({"##.##", "#####"}), {robot_at(2.5, 1.5).to(2.5, 1.5, 2.0)});
  EXPECT_FALSE(p.state.ways().way_to_goal(0, 1000, p.never).none());
}

TEST(StaticWays, KnowsThatRobotsCloseAWayUntilOneLeaves) {
  Planning p(support::ascii_map({"#.###",  //
                                 ".....",  //
                                 "#####"}),
             {robot_at(0.5, 1.5).to(4.5, 1.5), robot_at(2.5, 1.5).to(1.5, 2.5), robot_at(1.5, 2.5)});
  StaticWays& ways = p.state.ways();
  EXPECT_FALSE(ways.is_closed_off(0, kMany, p.never));
  p.reservations.stay_in_place(1);
  p.reservations.stay_in_place(2);
  ASSERT_TRUE(ways.is_closed_off(0, kMany, p.never));
  EXPECT_EQ(ways.way_to_goal(0).kind, Way::Kind::closed);
  EXPECT_EQ(ways.way_to_goal(0).closed_by, Robots{1});
  p.reservations.reserve_place(1, 3.0);
  EXPECT_EQ(ways.way_to_goal(0).kind, Way::Kind::unknown);
  EXPECT_FALSE(ways.way_to_goal(0, kMany, p.never).none());
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
