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
using Robots = std::vector<std::size_t>;

/// Robot 0 has to cross the middle of a hall, where robot 1 is.
struct Hall : Planning {
  Hall()
      : Planning(OccupancyGrid(9, 5, 1.0),
                 {robot_at(0.5, 2.5).to(8.5, 2.5), robot_at(4.5, 2.5).to(4.5, 4.5)}) {}

  /// The robots that conflict with a straight move of 8 s through the middle from t = `departure`.
  Robots crossing_conflicts(double departure = 0.0) const {
    return state.conflicting_robots(0, through({{0.5, 2.5}, {8.5, 2.5}}, departure));
  }
};

TEST(PlanState, IsEmptyAtFirst) {
  Hall p;
  EXPECT_EQ(p.crossing_conflicts(), Robots{});
  EXPECT_FALSE(p.state.trajectory(1));
  EXPECT_EQ(p.state.expansions(), 0);
}

TEST(PlanState, ReplacesTheReservationOfARobot) {
  Hall p;
  p.state.stay_in_place(1);
  EXPECT_EQ(p.crossing_conflicts(), Robots{1});
  EXPECT_EQ(p.crossing_conflicts(1000.0), Robots{1});
  p.state.follow(1, through({{4.5, 2.5}, {4.5, 4.5}}));
  EXPECT_TRUE(p.state.trajectory(1));
  EXPECT_EQ(p.crossing_conflicts(), Robots{}) << "robot 1 has left by then";
  p.state.follow(1, through({{4.5, 2.5}, {4.5, 4.5}}, 3.0));
  EXPECT_EQ(p.crossing_conflicts(), Robots{1}) << "robot 1 leaves too late";
  p.state.reserve_place(1, 3.1);
  EXPECT_FALSE(p.state.trajectory(1));
  EXPECT_EQ(p.crossing_conflicts(), Robots{}) << "robot 0 arrives later than that";
  p.state.reserve_place(1, 3.3);
  EXPECT_EQ(p.crossing_conflicts(), Robots{1});
  p.state.remove(1);
  EXPECT_EQ(p.crossing_conflicts(), Robots{});
}

TEST(PlanState, ReservesNothingForZeroSeconds) {
  Hall p;
  p.state.stay_in_place(1);
  p.state.reserve_place(1, 0.0);
  EXPECT_EQ(p.state.conflicting_robots(0, through({{4.5, 2.5}, {5.5, 2.5}})), Robots{});
}

TEST(PlanState, FindsRobotsThatCrossAPlace) {
  Hall p;
  p.state.follow(0, through({{0.5, 2.5}, {8.5, 2.5}}));
  EXPECT_EQ(p.state.robots_crossing_place(1), Robots{0});
  p.state.follow(0, through({{0.5, 2.5}, {0.5, 4.5}, {8.5, 4.5}}));
  EXPECT_EQ(p.state.robots_crossing_place(1), Robots{});
}

TEST(PlanState, PlansAmongReservationsWithoutChangingThem) {
  Hall p;
  p.state.stay_in_place(1);
  const auto found = p.state.plan(0, {}, p.never).trajectory;
  ASSERT_TRUE(found);
  EXPECT_GT(found->cost, 8.0) << "around robot 1";
  EXPECT_FALSE(p.state.trajectory(0));
  EXPECT_GT(p.state.expansions(), 0);
  p.state.follow(0, *found);
  support::expect_safe(p.state);
}

TEST(PlanState, PlansARobotAloneOnTheMap) {
  Hall p;
  p.state.stay_in_place(1);
  const Trajectory alone = p.state.plan_alone(0, p.never);
  EXPECT_NEAR(alone.cost, 8.0, 1e-12);
  EXPECT_EQ(p.state.conflicting_robots(0, alone), Robots{1});
}

TEST(PlanState, PlansARobotWithoutAPathToStayAtItsStart) {
  Planning p(support::ascii_map({"..#..", "..#.."}), {robot_at(0.5, 0.5).to(4.5, 0.5)});
  EXPECT_TRUE(p.state.way_to_goal(0, 1000, p.never).none());
  const Trajectory alone = p.state.plan_alone(0, p.never);
  EXPECT_TRUE(alone.moves.empty());
  EXPECT_EQ(alone.start, Position(0.5, 0.5));
}

/// Robot 0 may cross the middle of a hall, through which robot 1 is committed to drive from above, from t = 0
/// to t = 3. It ends below the way of robot 0.
struct CommittedHall : Planning {
  CommittedHall()
      : Planning(OccupancyGrid(9, 5, 1.0), {robot_at(0.5, 2.5).to(8.5, 2.5),
                                            robot_at(4.5, 3.5, -kPi / 2).to(0.5, 4.5).drives(4.5, 0.5)}) {}
  static constexpr double kPi = 3.141592653589793;

  Trajectory towards_it() const { return through({{3.5, 2.5}, {4.5, 2.5}, {4.5, 4.5}}); }
};

TEST(PlanState, AlwaysReservesCommittedMotion) {
  CommittedHall p;
  const Trajectory early = p.towards_it();
  EXPECT_EQ(p.state.robots_committed_against(0, early), Robots{1});
  EXPECT_EQ(p.state.conflicting_robots(0, early), Robots{}) << "committed motion does not change";
  p.state.stay_in_place(1);
  p.state.remove(1);
  EXPECT_EQ(p.state.robots_committed_against(0, early), Robots{1});
  EXPECT_EQ(p.state.robots_committed_against(1, p.instance.itinerary(1).committed), Robots{});
}

TEST(PlanState, ARobotStaysAtItsCommittedEnd) {
  CommittedHall p;
  const Trajectory below = through({{0.5, 0.5}, {8.5, 0.5}}, 10.0);
  EXPECT_EQ(p.state.conflicting_robots(0, below), Robots{});
  p.state.stay_in_place(1);
  EXPECT_EQ(p.state.conflicting_robots(0, below), Robots{1});
  EXPECT_EQ(p.state.conflicting_robots(0, through({{4.5, 2.5}, {4.5, 4.5}}, 3.0)), Robots{})
      << "it has left its start for good";
  p.state.reserve_place(1, 9.0);
  EXPECT_EQ(p.state.conflicting_robots(0, below), Robots{}) << "until t = 12, and robot 0 arrives after 13";
  p.state.reserve_place(1, 11.0);
  EXPECT_EQ(p.state.conflicting_robots(0, below), Robots{1});
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

TEST(PlanState, FollowsATrajectoryThatBeginsWithCommittedMotion) {
  CommittedHall p;
  Trajectory trajectory = through({{4.5, 3.5}, {4.5, 0.5}, {8.5, 0.5}});
  p.state.follow(1, trajectory);
  EXPECT_TRUE(p.state.trajectory(1));
  EXPECT_EQ(p.state.conflicting_robots(0, through({{4.5, 3.5}, {4.5, 2.5}})), Robots{})
      << "only the committed part";
  EXPECT_EQ(p.state.conflicting_robots(0, through({{8.5, 2.5}, {8.5, 0.5}}, 4.0)), Robots{1});
  const auto before = p.state.reservations();
  p.state.remove(1);
  p.state.restore(before);
  EXPECT_TRUE(p.state.trajectory(1));
}

TEST(PlanState, SearchesAmongWhatWasSetWithoutTableOnceItResumes) {
  CommittedHall p;
  const Trajectory across = through({{8.5, 2.5}, {8.5, 0.5}}, 4.0);
  const Trajectory below = through({{0.5, 0.5}, {8.5, 0.5}}, 10.0);
  p.state.follow(1, through({{4.5, 3.5}, {4.5, 0.5}, {8.5, 0.5}}));
  const PlanState::Reservations following = p.state.reservations();
  p.state.stay_in_place(1);
  const PlanState::Reservations staying = p.state.reservations();
  ASSERT_EQ(p.state.conflicting_robots(0, across), Robots{});

  p.state.set_without_table(following);
  p.state.resume();
  EXPECT_EQ(p.state.conflicting_robots(0, across), Robots{1});

  p.state.set_without_table(staying);
  p.state.restore(following);
  EXPECT_EQ(p.state.conflicting_robots(0, across), Robots{1});

  p.state.set_without_table(staying);
  p.state.restore(staying);
  EXPECT_EQ(p.state.conflicting_robots(0, across), Robots{});
  EXPECT_EQ(p.state.conflicting_robots(0, below), Robots{1});
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

TEST(PlanState, FindsAGoalAtTheStartReachable) {
  Planning p(support::ascii_map({"##.##", "#####"}), {robot_at(2.5, 1.5).to(2.5, 1.5, 2.0)});
  EXPECT_FALSE(p.state.way_to_goal(0, 1000, p.never).none());
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
