// The moves of a search: lattice moves, any angle, added waits.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "core/geometry/position.h"
#include "core/sipp/aa_sipp.h"
#include "tests/core/support/planning.h"
#include "tests/support/random_problem.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::expect_safe;
using support::robot_at;

constexpr double kPi = std::numbers::pi;

PlanOptions lattice_only(int connectivity) {
  PlanOptions options;
  options.any_angle = false;
  options.connectivity = connectivity;
  return options;
}

Trajectory plan_first(Planning& p) {
  const SearchResult result = p.state.plan(0, kExact, p.never);
  EXPECT_TRUE(result.trajectory);
  if (!result.trajectory) return {};
  p.reservations.follow(0, *result.trajectory);
  expect_safe(p.reservations);
  return *result.trajectory;
}

class AaSippConnectivity : public testing::TestWithParam<int> {};

TEST_P(AaSippConnectivity, UsesOnlyLatticeStepsWithoutAnyAngle) {
  Planning p(support::ascii_map({"............",  //
                                 "....#.......",  //
                                 "....#..#....",  //
                                 ".......#....",  //
                                 ".......#....",  //
                                 "............"}),
             {robot_at(0.5, 0.5).to(10.5, 3.5)}, lattice_only(GetParam()));
  const Trajectory trajectory = plan_first(p);
  for (const TimedSegment& move : trajectory.moves) {
    const Position d = move.path.to - move.path.from;
    bool is_step = false;
    for (const auto [columns, rows] : p.instance.lattice(0).steps()) {
      const Position step(columns, rows);
      const double along = d.dot(step) / (d.norm() * step.norm());
      is_step = is_step || along > 1.0 - 1e-12;
    }
    EXPECT_TRUE(is_step) << d.transpose();
  }
}

TEST_P(AaSippConnectivity, AnyAngleCostsNoMoreThanLatticeMoves) {
  const std::uint64_t seed = 37;
  support::Dice dice(seed);
  int compared = 0;
  for (int k = 0; k < 40; ++k) {
    SCOPED_TRACE(testing::Message() << "seed " << seed << ", problem " << k);
    const Problem problem = support::random_problem(dice, 1);
    if (!problem.robots()[0].goal) continue;
    Planning lattice(problem, lattice_only(GetParam()));
    PlanOptions options = lattice_only(GetParam());
    options.any_angle = true;
    Planning free(problem, options);
    const auto on_lattice = lattice.state.plan(0, kExact, lattice.never).trajectory;
    const auto at_any_angle = free.state.plan(0, kExact, free.never).trajectory;
    ASSERT_EQ(on_lattice.has_value(), at_any_angle.has_value()) << "the same vertices are reachable";
    if (!on_lattice) continue;
    ++compared;
    const auto& robot = problem.robots()[0];
    if (free.instance.sight_past_walls().may_sweep(robot.start.position, robot.goal->position,
                                                   robot.radius)) {
      ASSERT_LE(at_any_angle->cost, on_lattice->cost + 1e-8);
    }
  }
  EXPECT_GT(compared, 10);
}

INSTANTIATE_TEST_SUITE_P(Connectivities, AaSippConnectivity, testing::Values(4, 8, 16, 32));

TEST(AaSippMoves, HigherConnectivityCostsLess) {
  double last = kForever;
  for (const int connectivity : {4, 8, 16, 32}) {
    Planning p(OccupancyGrid(12, 12, 1.0), {robot_at(0.5, 0.5).to(9.5, 3.5).speeds(1.0, 100.0)},
               lattice_only(connectivity));
    const double cost = plan_first(p).cost;
    EXPECT_LT(cost, last + 1e-9) << connectivity;
    last = cost;
  }
  EXPECT_NEAR(last, std::hypot(9.0, 3.0) + std::atan2(3.0, 9.0) / 100.0, 1e-9) << "(3, 1) is a step of 32";
}

TEST(AaSippMoves, CollinearMovesAreJoined) {
  Planning p(OccupancyGrid(9, 1, 1.0), {robot_at(0.5, 0.5).to(8.5, 0.5)}, lattice_only(4));
  const Trajectory trajectory = plan_first(p);
  ASSERT_EQ(trajectory.moves.size(), 1u);
  EXPECT_NEAR(trajectory.cost, 8.0, 1e-12);
}

TEST(AaSippMoves, WaitOnlyBeforeFirstOfCollinearMoves) {
  PlanOptions options = lattice_only(4);
  options.wait_before_move = 1.5;
  Planning p(OccupancyGrid(9, 1, 1.0), {robot_at(0.5, 0.5).to(8.5, 0.5)}, options);
  const Trajectory trajectory = plan_first(p);
  ASSERT_EQ(trajectory.moves.size(), 1u);
  EXPECT_NEAR(trajectory.moves[0].t_start, 1.5, 1e-12);
  EXPECT_NEAR(trajectory.cost, 9.5, 1e-12);
}

TEST(AaSippMoves, WaitAfterEveryRotation) {
  PlanOptions options = lattice_only(4);
  options.wait_before_move = 1.5;
  Planning p(support::ascii_map({"###.",  //
                                 "###.",  //
                                 "...."}),
             {robot_at(0.5, 0.5).to(3.5, 2.5)}, options);
  const Trajectory trajectory = plan_first(p);
  ASSERT_EQ(trajectory.moves.size(), 2u);
  EXPECT_NEAR(trajectory.moves[1].t_start, 1.5 + 3.0 + 1.0 + 1.5, 1e-12) << "wait, translate, rotate, wait";
  EXPECT_NEAR(trajectory.cost, 9.0, 1e-12);
}

TEST(AaSippMoves, WaitForAnotherRobotCountsAsAddedWait) {
  PlanOptions options;
  options.wait_before_move = 2.0;
  Planning p(OccupancyGrid(10, 1, 1.0), {robot_at(0.5, 0.5).to(5.5, 0.5), robot_at(1.5, 0.5).to(9.5, 0.5)},
             options);
  p.reservations.follow(1, through({{1.5, 0.5}, {9.5, 0.5}}, 7.0));
  EXPECT_NEAR(plan_first(p).cost, 11.8, 1e-8) << "0.2 m behind the other robot, which leaves at t = 7";
}

/// Robot 0 translates from x = 1.5 to x = 5.5. The others cross its path upwards, each at the given x and
/// time. All have radius 0.3.
Planning with_crossing_robots(const std::vector<std::pair<double, double>>& crossings,
                              const PlanOptions& options) {
  constexpr double kRow = 30.5;
  std::vector<Robot> robots{robot_at(1.5, kRow).to(5.5, kRow).radius(0.3)};
  for (const auto& [x, t] : crossings) {
    robots.push_back(robot_at(x, kRow - t, kPi / 2.0).to(x, kRow - t + 30.0).radius(0.3));
  }
  return Planning(OccupancyGrid(8, 62, 1.0), robots, options);
}

TEST(AaSippMoves, LaterArrivalContinuesStraightIfEarlierOneMustWait) {
  PlanOptions options = lattice_only(4);
  options.wait_before_move = 10.0;
  // Beyond x = 3.5 the path is free for a departure from there at about 15.35 s, and then only after 22 s. A
  // robot that arrives there at 12 s and makes the added wait is too late.
  const std::vector<std::pair<double, double>> crossings{{2.5, 13.5}, {4.2, 12.2}, {4.2, 13.65}, {4.2, 15.05},
                                                         {4.2, 17.1}, {4.2, 18.7}, {4.2, 20.3},  {4.2, 21.9}};
  Planning p = with_crossing_robots(crossings, options);
  for (std::size_t k = 1; k < p.instance.size(); ++k) {
    const auto& robot = p.instance.problem().robots()[k];
    p.reservations.follow(k, through({robot.start.position, robot.goal->position}));
  }
  EXPECT_NEAR(plan_first(p).cost, 13.5 + 0.6 * std::sqrt(2.0) + 3.0, 1e-6) << "close behind the first robot";
}

TEST(AaSippMoves, SlowRotationDelaysDeparture) {
  Planning p(OccupancyGrid(10, 10, 1.0), {robot_at(1.5, 1.5, kPi).to(4.5, 1.5).speeds(1.0, 0.1)});
  EXPECT_NEAR(plan_first(p).cost, 3.0 + 10.0 * kPi, 1e-9);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
