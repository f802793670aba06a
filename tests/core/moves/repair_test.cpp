#include "core/moves/repair.h"

#include <gtest/gtest.h>

#include <utility>

#include "core/moves/safe_plan.h"
#include "tests/core/support/planning.h"
#include "tests/support/random_problem.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::expect_safe;
using support::robot_at;
using Robots = std::vector<std::size_t>;

/// Robot 0, if it is planned first, blocks the entrance of a dead end before robot 1 has passed.
Planning blocked_entrance() {
  return Planning(
      support::ascii_map({"#######.#",  //
                          ".........",  //
                          "........."}),
      {robot_at(7.5, 0.5).to(7.5, 1.5), robot_at(0.5, 1.5).to(7.5, 2.5), robot_at(0.5, 0.5).to(2.5, 0.5)});
}

/// A pace that asks before the second robot, once, and counts its looks.
RepairPace asks_before_the_second(int& looks, OnStop on_stop) {
  return {std::move(on_stop), [&looks] { return ++looks == 2; }};
}

void expect_all_planned(const Planning& p, const OrderingResult& result) {
  EXPECT_TRUE(result.unsolved.empty());
  for (std::size_t robot = 0; robot < 3; ++robot) EXPECT_TRUE(p.reservations.trajectory(robot));
  expect_safe(p.reservations);
}

TEST(Repair, RaisesAFailedRobotAndReplansOnlyConflictingRobots) {
  Planning p = blocked_entrance();
  Random random(7);
  const OrderingResult result = repair_all(p.state, {2, 0, 1}, p.steps, random, p.never, p.progress);
  EXPECT_TRUE(result.unsolved.empty());
  EXPECT_TRUE(result.given_up.empty());
  EXPECT_EQ(result.attempts, 2) << "robot 1 failed once";
  for (std::size_t robot = 0; robot < 3; ++robot) EXPECT_TRUE(p.reservations.trajectory(robot));
  EXPECT_GT(p.reservations.trajectory(0)->cost, 7.0) << "it waits for robot 1";
  EXPECT_DOUBLE_EQ(p.reservations.trajectory(2)->cost, 2.0) << "it conflicted with no robot";
  expect_safe(p.reservations);
}

TEST(Repair, GoesOnFromASafePlanThatWasMadeMeanwhile) {
  Planning p = blocked_entrance();
  Random random(7);
  int looks = 0;
  const RepairPace pace = asks_before_the_second(looks, [&](const OrderingResult& so_far) {
    EXPECT_EQ(so_far.unsolved, (Robots{0, 1})) << "robot 2 has a plan";
    make_safe(p.state, so_far.unsolved, so_far.given_up, Effort::none, p.never, p.progress);
    for (const std::size_t robot : so_far.unsolved) EXPECT_TRUE(p.reservations.stays(robot));
    return true;
  });
  const OrderingResult result = repair_all(p.state, {2, 0, 1}, p.steps, random, p.never, p.progress, pace);
  EXPECT_GT(looks, 2) << "it went on";
  expect_all_planned(p, result);
}

TEST(Repair, EndsIfAllRobotsWerePlannedMeanwhile) {
  Planning p = blocked_entrance();
  Random random(7);
  int looks = 0;
  const RepairPace pace = asks_before_the_second(looks, [&](const OrderingResult& so_far) {
    return repair_around(p.state, so_far.unsolved, random, p.never, p.progress).unsolved.empty();
  });
  const OrderingResult result = repair_all(p.state, {2, 0, 1}, p.steps, random, p.never, p.progress, pace);
  EXPECT_EQ(looks, 2) << "nobody was left to plan";
  EXPECT_FALSE(result.cut_off);
  expect_all_planned(p, result);
}

TEST(Repair, EndsWhereItsPaceDoesNotGoOn) {
  Planning p = blocked_entrance();
  Random random(7);
  const RepairPace pace{[](const OrderingResult&) { return false; }, [] { return true; }};
  const OrderingResult result = repair_all(p.state, {2, 0, 1}, p.steps, random, p.never, p.progress, pace);
  EXPECT_EQ(result.unsolved, (Robots{2, 0, 1}));
  EXPECT_TRUE(result.cut_off);
}

TEST(Repair, GivesUpARobotWithoutAPathAmongRobotsThatStay) {
  Planning p(support::ascii_map({"....#....",  //
                                 ".........",  //
                                 "....#...."}),
             {robot_at(4.5, 1.5), robot_at(0.5, 1.5).to(8.5, 1.5), robot_at(8.5, 0.5).to(5.5, 0.5)});
  p.reservations.stay_in_place(0);
  Random random(7);
  const OrderingResult result = repair_all(p.state, {1, 2}, p.steps, random, p.never, p.progress);
  EXPECT_EQ(result.given_up, Robots{1});
  EXPECT_TRUE(result.unsolved.empty());
  EXPECT_TRUE(p.reservations.trajectory(2));
  expect_safe(p.reservations);
}

TEST(Repair, BreaksACycleOfRaisedRobotsByAStartDelay) {
  // The bay is in the middle: without a delay no robot reaches it before the other.
  Planning p(support::ascii_map({"####.####",  //
                                 "........."}),
             {robot_at(0.5, 0.5).to(8.5, 0.5), robot_at(8.5, 0.5, 3.0).to(0.5, 0.5)});
  Random random(7);
  const OrderingResult result = repair_all(p.state, {0, 1}, p.steps, random, p.never, p.progress);
  EXPECT_TRUE(result.unsolved.empty());
  EXPECT_GT(result.attempts, 4) << "a delay is tried only after several failures";
  expect_safe(p.reservations);
}

TEST(Repair, GivesUpARobotThatKeepsFailing) {
  // Robots 0 and 1 cannot change places.
  Planning p(
      support::ascii_map({".......##",  //
                          "#########",  //
                          "........."}),
      {robot_at(0.5, 2.5).to(6.5, 2.5), robot_at(6.5, 2.5, 3.0).to(0.5, 2.5), robot_at(0.5, 0.5).to(4.5, 0.5),
       robot_at(1.5, 0.5).to(6.5, 0.5), robot_at(3.5, 0.5).to(8.5, 0.5)});
  Random random(7);
  const OrderingResult result = repair_all(p.state, {0, 1, 2, 3, 4}, p.steps, random, p.never, p.progress);
  EXPECT_TRUE(result.unsolved.empty());
  EXPECT_EQ(result.given_up, (Robots{1, 0})) << "each blocks the other";
  for (const std::size_t robot : {2u, 3u, 4u}) EXPECT_TRUE(p.reservations.trajectory(robot));
  expect_safe(p.reservations);
}

/// Robots of one size that start and end in random cells of an empty hall.
std::vector<Robot> crowd(int columns, int rows, int count, std::uint64_t seed) {
  support::Dice dice(seed);
  const auto random_cells = [&] {
    std::vector<Position> cells;
    for (int k = 0; k < columns * rows; ++k) cells.emplace_back(k % columns + 0.5, k / columns + 0.5);
    for (int k = 0; k < count; ++k) std::swap(cells[k], cells[k + dice.below(columns * rows - k)]);
    return cells;
  };
  const std::vector<Position> starts = random_cells();
  const std::vector<Position> goals = random_cells();
  std::vector<Robot> robots;
  for (int k = 0; k < count; ++k) {
    robots.push_back(robot_at(starts[k].x(), starts[k].y()).to(goals[k].x(), goals[k].y()));
  }
  return robots;
}

TEST(Repair, PlansACrowdThatFillsTwoFifthsOfTheFloor) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    Planning p(OccupancyGrid(12, 12, 1.0), crowd(12, 12, 58, seed));
    Random random(7);
    const OrderingResult result = repair_all(p.state, p.movers(), p.steps, random, p.never, p.progress);
    EXPECT_TRUE(result.unsolved.empty()) << "seed " << seed;
    EXPECT_TRUE(result.given_up.empty()) << "seed " << seed;
    EXPECT_EQ(p.reservations.planned_count(), 58u) << "seed " << seed;
    EXPECT_GT(result.attempts, 5) << "seed " << seed << " is no crowd";
    expect_safe(p.reservations);
  }
}

TEST(Repair, ReturnsUnsolvedRobotsByPriorityWhenStopped) {
  Planning p = blocked_entrance();
  Random random(7);
  const OrderingResult result = repair_all(p.state, {2, 0, 1}, p.steps, random, met(), p.progress);
  EXPECT_EQ(result.unsolved, (Robots{2, 0, 1}));
  EXPECT_TRUE(result.cut_off);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
