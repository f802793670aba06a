#include "core/fleet/plan_state.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "core/runtime/memory_account.h"
#include "tests/core/support/planning.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::robot_at;
using Hall = CrossedHall;
using Robots = std::vector<std::size_t>;

TEST(PlanState, PlansAmongReservationsWithoutChangingThem) {
  Hall p;
  EXPECT_EQ(p.state.expansions(), 0);
  p.reservations.stay_in_place(1);
  const auto found = p.state.plan(0, {}, p.never).trajectory;
  ASSERT_TRUE(found);
  EXPECT_GT(found->cost, 8.0) << "around robot 1";
  EXPECT_FALSE(p.reservations.trajectory(0));
  EXPECT_GT(p.state.expansions(), 0);
  p.reservations.follow(0, *found);
  support::expect_safe(p.reservations);
}

TEST(PlanState, PlansARobotAloneOnTheMap) {
  Hall p;
  p.reservations.stay_in_place(1);
  const Trajectory alone = p.state.plan_alone(0, p.never);
  EXPECT_NEAR(alone.cost, 8.0, 1e-12);
  EXPECT_EQ(p.reservations.conflicting_robots(0, alone), Robots{1});
}

TEST(PlanState, PlansARobotWithoutAPathToStayAtItsStart) {
  Planning p(support::ascii_map({"..#..", "..#.."}), {robot_at(0.5, 0.5).to(4.5, 0.5)});
  EXPECT_TRUE(p.state.ways().way_to_goal(0, 1000, p.never).none());
  const Trajectory alone = p.state.plan_alone(0, p.never);
  EXPECT_TRUE(alone.moves.empty());
  EXPECT_EQ(alone.start, Position(0.5, 0.5));
}

TEST(PlanState, NeverIgnoresCommittedMotion) {
  Planning p(support::ascii_map({"####.####",  //
                                 ".........",  //
                                 "####.####"}),
             {robot_at(0.5, 1.5).to(8.5, 1.5), robot_at(4.5, 2.5).to(4.5, 2.5).waits(2.0).drives(4.5, 0.5)});
  const SearchResult result = p.state.plan_ignoring(0, {1}, {}, p.never);
  ASSERT_TRUE(result.trajectory);
  EXPECT_NEAR(result.trajectory->cost, 8.0 + 0.8 * std::sqrt(2.0), 1e-6) << "it lets robot 1 pass";
}

TEST(PlanState, FindsAWayPastAnIgnoredRobotThatIsKnownToCloseIt) {
  Planning p(support::ascii_map({"....#....",  //
                                 ".........",  //
                                 "....#...."}),
             {robot_at(0.5, 1.5).to(8.5, 1.5), robot_at(4.5, 1.5).to(4.5, 1.5)});
  p.reservations.stay_in_place(1);
  ASSERT_TRUE(p.state.ways().is_closed_off(0, 1000, p.never));
  EXPECT_FALSE(p.state.plan(0, {}, p.never).trajectory);
  const auto found = p.state.plan_ignoring(0, {1}, {}, p.never).trajectory;
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->cost, 8.0, 1e-12);
  EXPECT_FALSE(p.state.plan(0, {}, p.never).trajectory);
}

/// Robot 1 closes the door of a hall, in which robot 0 has to go around a row of others that stay.
TEST(PlanState, FindsAWholeWayPastAnIgnoredRobotThatClosesIt) {
  OccupancyGrid grid(60, 41, 1.0);
  for (int row = 0; row < 41; ++row) {
    if (row != 20) grid.block({50, row});
  }
  std::vector<Robot> robots{robot_at(2.5, 20.5).to(58.5, 20.5), robot_at(50.5, 20.5).to(50.5, 20.5)};
  for (int row = 0; row < 39; ++row) robots.push_back(robot_at(40.5, row + 0.5).to(40.5, row + 0.5));
  PlanOptions options;
  options.horizon = 5.0;
  Planning p(std::move(grid), std::move(robots), options);
  for (std::size_t other = 1; other < p.instance.size(); ++other) p.reservations.stay_in_place(other);
  p.state.set_whole_way_of(0);
  const auto found = p.state.plan_ignoring(0, {1}, {}, p.never).trajectory;
  EXPECT_GT(p.state.expansions(), SearchSettings::kFirstTest);
  ASSERT_TRUE(found);
  EXPECT_GT(found->cost, 56.0) << "around the row";
  EXPECT_EQ(found->end(), Position(58.5, 20.5));
  EXPECT_EQ(p.state.whole_way_of(), std::size_t{0});
}

TEST(PlanState, GivesUpWhatSearchesKeepWhenMemoryIsShort) {
  constexpr std::size_t kLimit = std::size_t{64} << 20;
  MemoryAccount account(kLimit);
  const MemoryScope scope(&account);
  OccupancyGrid hall(120, 120, 1.0);
  for (int row = 0; row < 110; ++row) hall.block({60, row});
  Planning p(std::move(hall), {robot_at(0.5, 0.5).to(119.5, 0.5)});
  ASSERT_TRUE(p.state.plan(0, {}, p.never).trajectory);
  const std::int64_t with_caches = account.used();

  p.state.memory().relieve();
  EXPECT_EQ(account.used(), with_caches) << "memory is not short";

  const std::vector<char> others(kLimit * 3 / 4 - static_cast<std::size_t>(with_caches) + 100'000);
  ASSERT_TRUE(account.is_short());
  p.state.memory().relieve();
  EXPECT_FALSE(account.is_short());
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
