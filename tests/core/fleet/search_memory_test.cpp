#include "core/fleet/search_memory.h"

#include <gtest/gtest.h>

#include "core/runtime/memory_account.h"
#include "core/runtime/stop_condition.h"
#include "tests/core/support/planning.h"
#include "tests/support/step_limit.h"

namespace fleetplan::core {
namespace TEST_FILE {

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
  SearchSpace& space = *spaces.of(robot, StopCondition::never());
  space.cost_to_go(0).from(space.vertices().start(), StopCondition::never());
  ASSERT_GT(space.bytes(), 0);
}

/// The memory of a job with three robots.
struct JobMemory {
  /// Leaves so little that spaces are discarded, although the job is not short of memory yet.
  void use_most() { account.count(account.limit() * 23 / 32); }

  MemoryAccount account{1 << 20};
  const MemoryScope scope{&account};
  const Planning p = three_robots();
  SearchSpaces spaces{p.instance};
};

TEST(SearchSpaces, AreKeptFromSearchToSearch) {
  const Planning p = three_robots();
  SearchSpaces spaces(p.instance);
  for (std::size_t robot = 0; robot < 3; ++robot) search_back(spaces, robot);
  for (std::size_t robot = 0; robot < 3; ++robot)
    EXPECT_GT(spaces.of(robot, StopCondition::never())->bytes(), 0);
}

TEST(SearchSpaces, DiscardTheLeastRecentlyUsedWithoutMemory) {
  JobMemory memory;
  SearchSpaces& spaces = memory.spaces;
  search_back(spaces, 0);
  search_back(spaces, 1);
  spaces.of(0, StopCondition::never());
  memory.use_most();
  spaces.of(2, StopCondition::never());
  EXPECT_GT(spaces.of(0, StopCondition::never())->bytes(), 0);
  EXPECT_EQ(spaces.of(1, StopCondition::never())->bytes(), 0);
}

TEST(SearchSpaces, DiscardThoseFirstThatAreUsedLast) {
  JobMemory memory;
  SearchSpaces& spaces = memory.spaces;
  for (const std::size_t robot : {0u, 1u}) search_back(spaces, robot);
  spaces.expect_use(1, 5);
  spaces.expect_use(0, 3);
  memory.use_most();
  spaces.of(2, StopCondition::never());
  EXPECT_GT(spaces.of(0, StopCondition::never())->bytes(), 0);
  EXPECT_EQ(spaces.of(1, StopCondition::never())->bytes(), 0) << "used after 0, although less long ago";
}

TEST(SearchSpaces, KeepTheOneInUseWhenMemoryIsNearlyShort) {
  JobMemory memory;
  SearchSpaces& spaces = memory.spaces;
  search_back(spaces, 0);
  memory.use_most();
  EXPECT_GT(spaces.of(0, StopCondition::never())->bytes(), 0);
}

TEST(SearchSpaces, AreAllDiscarded) {
  const Planning p = three_robots();
  SearchSpaces spaces(p.instance);
  search_back(spaces, 0);
  spaces.discard_all();
  EXPECT_EQ(spaces.of(0, StopCondition::never())->bytes(), 0);
}

/// A robot with so many goals off the lattice that comparing them with each other takes long.
TEST(SearchSpaces, AreNotMadeIfTheStopConditionIsMet) {
  Robot robot = robot_at(0.5, 0.5).to(4.5, 0.5).radius(0.1);
  for (int k = 0; k < 300; ++k) robot.via.push_back({Position(1.03 + 0.01 * k, 1.02), {}});
  const Planning p(support::ascii_map({".......", ".......", "......."}), {robot});
  SearchSpaces spaces(p.instance);
  support::StepLimit none(0);
  EXPECT_EQ(spaces.of(0, support::counted(none)), nullptr);
  EXPECT_EQ(none.steps(), 1);
  support::StepLimit enough;
  SearchSpace* made = spaces.of(0, support::counted(enough));
  ASSERT_NE(made, nullptr);
  EXPECT_TRUE(made->finished());
  EXPECT_GT(enough.steps(), 5);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
