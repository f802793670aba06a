#include "core/prioritized/plan_state.h"

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
  const SearchResult result = p.state.plan_ignoring({1}, 0, {}, p.never);
  ASSERT_TRUE(result.trajectory);
  EXPECT_NEAR(result.trajectory->cost, 8.0 + 0.8 * std::sqrt(2.0), 1e-6) << "it lets robot 1 pass";
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

  p.state.relieve_memory();
  EXPECT_EQ(account.used(), with_caches) << "memory is not short";

  const std::vector<char> others(kLimit * 3 / 4 - static_cast<std::size_t>(with_caches) + 100'000);
  ASSERT_TRUE(account.is_short());
  p.state.relieve_memory();
  EXPECT_FALSE(account.is_short());
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
