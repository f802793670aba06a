#include "core/prioritized/search_spaces.h"

#include <gtest/gtest.h>

#include "core/runtime/memory_account.h"
#include "tests/core/support/planning.h"

namespace fleetplan::core {
namespace {

using support::robot_at;

/// Three robots that go around a wall.
Planning three_robots() {
  return Planning(support::ascii_map({".......",  //
                                      "..#....",  //
                                      "..#....",  //
                                      "..#....",  //
                                      "..#...."}),
                  {robot_at(0.5, 0.5).to(4.5, 0.5).radius(0.3), robot_at(0.5, 1.5).to(4.5, 1.5).radius(0.3),
                   robot_at(0.5, 2.5).to(4.5, 2.5).radius(0.3)});
}

void search_back(SearchSpaces& spaces, std::size_t robot) {
  SearchSpace& space = *spaces.of(robot, StopCondition());
  space.cost_to_go(0).from(space.vertices().start(), {});
  ASSERT_GT(space.expansions(), 0);
}

TEST(SearchSpaces, AreKeptFromSearchToSearch) {
  const Planning p = three_robots();
  SearchSpaces spaces(p.instance);
  for (std::size_t robot = 0; robot < 3; ++robot) search_back(spaces, robot);
  for (std::size_t robot = 0; robot < 3; ++robot)
    EXPECT_GT(spaces.of(robot, StopCondition())->expansions(), 0);
}

TEST(SearchSpaces, DiscardTheLeastRecentlyUsedWithoutMemory) {
  const Planning p = three_robots();
  MemoryAccount account(1 << 20);
  const MemoryScope scope(&account);
  SearchSpaces spaces(p.instance);
  search_back(spaces, 0);
  search_back(spaces, 1);
  spaces.of(0, StopCondition());
  account.count(account.limit() * 5 / 8);
  spaces.of(2, StopCondition());
  EXPECT_GT(spaces.of(0, StopCondition())->expansions(), 0);
  EXPECT_EQ(spaces.of(1, StopCondition())->expansions(), 0);
}

TEST(SearchSpaces, AreAllDiscarded) {
  const Planning p = three_robots();
  SearchSpaces spaces(p.instance);
  search_back(spaces, 0);
  spaces.discard_all();
  EXPECT_EQ(spaces.of(0, StopCondition())->expansions(), 0);
}

}  // namespace
}  // namespace fleetplan::core
