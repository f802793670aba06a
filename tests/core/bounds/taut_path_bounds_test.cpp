#include "core/bounds/taut_path_bounds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/bounds/lower_bound.h"
#include "core/compile/instance.h"
#include "tests/core/support/planning.h"
#include "tests/support/random_problem.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::ascii_map;
using support::make_problem;
using support::robot_at;

constexpr double kPi = std::numbers::pi;
/// Tolerance in seconds, because TautPathSearch takes the disk slightly smaller.
constexpr double kReduction = 1e-5;

/// `cost`: the cost of a known plan.
double bound_of(const Problem& problem, const PlanOptions& options = {}, double cost = kForever) {
  const Instance instance(problem, options, StopCondition::never());
  const TautPathBounds bounds(instance, {0}, {cost}, StopCondition::never());
  EXPECT_FALSE(bounds.cut_off());
  return bounds[0];
}

double straight_bound_of(const Problem& problem) {
  const Instance instance(problem, {}, StopCondition::never());
  return straight_bound(instance, 0);
}

std::optional<double> cost_alone(const Problem& problem, const PlanOptions& options = {}) {
  const Instance instance(problem, options, StopCondition::never());
  PlanState state(instance);
  const auto found = state.plan(0, {kForever, 0.0}, StopCondition::never()).trajectory;
  return found ? std::optional(found->cost) : std::nullopt;
}

OccupancyGrid wall() {
  return ascii_map({".......",  //
                    ".......",  //
                    "...#...",  //
                    "...#...",  //
                    "...#..."});
}

TEST(TautPathBounds, AreTheStraightLineAndItsRotationsWithoutObstacles) {
  const Problem problem = make_problem(wall(), {robot_at(0.5, 0.5, 1.0).to(1.5, 4.5, 2.0)});
  EXPECT_EQ(bound_of(problem), straight_bound_of(problem));
}

TEST(TautPathBounds, GoAroundAWallOnArcsOfTheRadius) {
  // Up to a point above the corner (3, 3), and down from a point above (4, 3) with the same slope.
  const double rise = std::atan2(1.5, 1.5) + std::asin(0.5 / std::hypot(1.5, 1.5));
  const double reach = std::sqrt(1.5 * 1.5 + 1.5 * 1.5 - 0.5 * 0.5);
  const double length = 2.0 * reach + 1.0 + 2.0 * 0.5 * rise;
  const Problem free_heading =
      make_problem(wall(), {robot_at(1.5, 1.5, rise).to(5.5, 1.5).radius(0.5).speeds(2.0, 0.5)});
  EXPECT_NEAR(bound_of(free_heading), length / 2.0 + 2.0 * rise / 0.5, kReduction);
  const Problem turned =
      make_problem(wall(), {robot_at(1.5, 1.5, kPi).to(5.5, 1.5, 0.0).radius(0.5).speeds(2.0, 0.5)});
  EXPECT_NEAR(bound_of(turned), length / 2.0 + (2.0 * rise + kPi) / 0.5, kReduction);
}

TEST(TautPathBounds, AreApproachedOnFinerLattices) {
  const OccupancyGrid rooms = ascii_map({".....#.....",  //
                                         "...........",  //
                                         ".....#.....",  //
                                         "##.#####.##",  //
                                         ".....#.....",  //
                                         ".....#.....",  //
                                         "..........."});
  const Problem problem = make_problem(rooms, {robot_at(0.5, 6.5, 1.0).to(10.5, 2.5, -1.0)});
  const auto cost_by_bound = [&](double spacing) {
    PlanOptions options;
    options.lattice_spacing = spacing;
    return cost_alone(problem, options).value() / bound_of(problem, options);
  };
  EXPECT_GT(cost_by_bound(1.0), 1.05);
  EXPECT_LT(cost_by_bound(1.0 / 9.0), 1.03);
  EXPECT_LT(cost_by_bound(1.0 / 27.0), 1.01);
}

TEST(TautPathBounds, AddAWaitForEachTranslationThatEveryPathNeeds) {
  const auto waits = [](const OccupancyGrid& grid, const Robot& robot) {
    const Problem problem = make_problem(grid, {robot});
    PlanOptions options;
    options.wait_before_move = 1e-3;  // too short to make another path better
    return (bound_of(problem, options) - bound_of(problem)) / options.wait_before_move;
  };
  EXPECT_NEAR(waits(wall(), robot_at(0.5, 0.5).to(0.5, 4.5)), 1.0, 1e-6);
  EXPECT_NEAR(waits(wall(), robot_at(1.5, 1.5).to(5.5, 1.5)), 2.0, 1e-6)
      << "one bend over the wall may suffice";
  const OccupancyGrid slalom = ascii_map({"...#......",  //
                                          "...#......",  //
                                          "...#..#...",  //
                                          "...#..#...",  //
                                          "......#...",  //
                                          "......#..."});
  EXPECT_NEAR(waits(slalom, robot_at(1.5, 3.5).to(8.5, 2.5)), 3.0, 1e-6) << "under, across, and over";
}

TEST(TautPathBounds, DoNotUseAGapThatJustFitsBetweenCellCentres) {
  const OccupancyGrid grid = ascii_map({"...............",  //
                                        "...............",  //
                                        "...............",  //
                                        "###..#######...",  //
                                        "...............",  //
                                        "...............",  //
                                        "..............."});
  const auto bound = [&](double radius) {
    return bound_of(make_problem(grid, {robot_at(2.5, 1.5).to(2.5, 5.5).radius(radius)}));
  };
  EXPECT_GT(bound(1.0), 20.0);
  EXPECT_LT(bound(0.99), 10.0);
}

TEST(TautPathBounds, UseAGapThatJustFitsAroundCellCentres) {
  const OccupancyGrid grid = ascii_map({"...............",  //
                                        "...............",  //
                                        "##.#########...",  //
                                        "...............",  //
                                        "..............."});
  const Problem problem = make_problem(grid, {robot_at(2.5, 0.5).to(3.5, 4.5).radius(0.5)});
  const auto cost = cost_alone(problem);
  ASSERT_TRUE(cost);
  EXPECT_LT(*cost, 10.0);
  EXPECT_LE(bound_of(problem), *cost);
}

TEST(TautPathBounds, UseAGapThatJustFitsFromAStartWithinIt) {
  const OccupancyGrid grid = ascii_map({".......",  //
                                        ".......",  //
                                        ".......",  //
                                        "###..##",  //
                                        ".......",  //
                                        ".......",  //
                                        "......."});
  const Problem problem = make_problem(grid, {robot_at(4.0, 3.5).to(1.5, 5.5).radius(1.0)});
  EXPECT_GT(bound_of(problem), straight_bound_of(problem) + 0.1);
  EXPECT_LT(bound_of(problem), 10.0);
}

std::string rooms_row(int row) {
  return row % 4 == 0 ? "######.#.######.#" : (row % 4 == 2 ? "....#...#.......#" : "....#...#...#...#");
}

TEST(TautPathBounds, AreCloseToTheCostOfTheRobotAlone) {
  std::vector<std::string> rooms;
  rooms.reserve(16);
  for (int row = 0; row < 16; ++row) rooms.push_back(rooms_row(row));
  std::vector<std::string> shelves;
  shelves.reserve(19);
  for (int row = 0; row < 19; ++row) {
    shelves.emplace_back(row % 3 == 0 ? ".............................." : "..##########...##########.....");
  }
  const auto ratio = [](const std::vector<std::string>& rows, double radius, double wait) {
    const OccupancyGrid grid = ascii_map(rows);
    PlanOptions options;
    options.wait_before_move = wait;
    support::Dice dice(7);
    double cost = 0.0;
    double bound = 0.0;
    for (int k = 0; k < 200; ++k) {
      const Cell from{dice.below(grid.columns()), dice.below(grid.rows())};
      const Cell to{dice.below(grid.columns()), dice.below(grid.rows())};
      if (grid.blocked(from) || grid.blocked(to) || from == to) continue;
      const Position a = grid.center(from);
      const Position b = grid.center(to);
      const Problem problem =
          make_problem(grid, {robot_at(a.x(), a.y()).to(b.x(), b.y(), 1.0).radius(radius)});
      const auto alone = cost_alone(problem, options);
      if (!alone) continue;
      cost += *alone;
      bound += bound_of(problem, options);
    }
    EXPECT_GT(bound, 200.0);
    return cost / bound;
  };
  EXPECT_LT(ratio(rooms, 0.3, 0.0), 1.10);
  EXPECT_LT(ratio(rooms, 0.3, 1.0), 1.20);
  EXPECT_LT(ratio(shelves, 0.5, 0.0), 1.03);
  EXPECT_LT(ratio(shelves, 0.3, 0.0), 1.05);
}

/// A map of blocks with straight gaps between them.
OccupancyGrid blocks_and_gaps(support::Dice& dice) {
  OccupancyGrid grid(8 + dice.below(20), 8 + dice.below(20), dice.chance(0.5) ? 1.0 : 0.25);
  for (int block = dice.below(14); block > 0; --block) {
    const Cell low{dice.below(grid.columns()), dice.below(grid.rows())};
    const Cell size = dice.chance(0.5) ? Cell{1 + dice.below(10), 1 + dice.below(2)}
                                       : Cell{1 + dice.below(2), 1 + dice.below(10)};
    for (int row = low.row; row < std::min(grid.rows(), low.row + size.row); ++row) {
      for (int column = low.column; column < std::min(grid.columns(), low.column + size.column); ++column) {
        grid.block({column, row});
      }
    }
  }
  return grid;
}

/// A robot whose radius is a multiple of half a cell, so that it just fits into gaps. Poses are on multiples
/// of a quarter of a cell.
std::optional<Problem> snug_problem(support::Dice& dice) {
  OccupancyGrid grid = blocks_and_gaps(dice);
  std::vector<Robot> robots = support::random_robots(dice, grid, 1);
  if (robots.empty() || !robots[0].goal) return std::nullopt;
  const double cell = grid.resolution();
  robots[0].radius = cell * 0.5 * (1 + dice.below(3));
  const auto snap = [&](const Position& p) {
    return Position(0.25 * cell * (4.0 * p / cell).array().round().matrix());
  };
  robots[0].start.position = snap(robots[0].start.position);
  robots[0].goal->position = snap(robots[0].goal->position);
  auto problem = Problem::create(std::move(grid), std::move(robots), StopCondition::never());
  if (auto* valid = std::get_if<Problem>(&problem)) return std::move(*valid);
  return std::nullopt;
}

class TautPathBoundsOfRandomProblems : public testing::TestWithParam<bool> {};

TEST_P(TautPathBoundsOfRandomProblems, AreBetweenTheStraightLineAndTheCostOfTheRobotAlone) {
  const std::uint64_t seed = 53;
  support::Dice dice(seed);
  int better = 0;
  int close = 0;
  for (int k = 0; k < 3000; ++k) {
    SCOPED_TRACE(testing::Message() << "seed " << seed << ", problem " << k);
    const std::optional<Problem> problem =
        GetParam() ? snug_problem(dice) : std::optional(support::random_problem(dice, 1));
    if (!problem || !problem->robots()[0].goal) continue;
    const PlanOptions options = support::random_options(dice, *problem);
    const auto cost = cost_alone(*problem, options);
    if (!cost) continue;
    const double bound = bound_of(*problem, options);
    const Instance instance(*problem, options, StopCondition::never());
    const double straight = straight_bound(instance, 0);
    ASSERT_LE(bound, *cost * (1.0 + 1e-12) + 1e-9);
    ASSERT_GE(bound, straight);
    ASSERT_DOUBLE_EQ(bound_of(*problem, options, *cost), bound) << "with the cost known";
    ASSERT_DOUBLE_EQ(bound_of(*problem, options, bound), bound) << "with a known cost equal to the bound";
    better += bound > 1.01 * straight ? 1 : 0;
    close += *cost < 1.02 * bound && bound > 1.01 * straight ? 1 : 0;
  }
  EXPECT_GT(better, 200);
  EXPECT_GT(close, 50);
}

INSTANTIATE_TEST_SUITE_P(Snug, TautPathBoundsOfRandomProblems, testing::Bool());

TEST(TautPathBounds, AreTheSameForAMirroredMap) {
  const std::uint64_t seed = 59;
  support::Dice dice(seed);
  int around = 0;
  for (int k = 0; k < 400; ++k) {
    SCOPED_TRACE(testing::Message() << "seed " << seed << ", problem " << k);
    const Problem problem = support::random_problem(dice, 1);
    Robot robot = problem.robots()[0];
    if (!robot.goal) continue;
    const OccupancyGrid& grid = problem.grid();
    OccupancyGrid mirrored(grid.columns(), grid.rows(), grid.resolution());
    for (int row = 0; row < grid.rows(); ++row) {
      for (int column = 0; column < grid.columns(); ++column) {
        if (grid.blocked({grid.columns() - 1 - column, row})) mirrored.block({column, row});
      }
    }
    const auto mirror = [&](double theta) { return normalize_angle(kPi - theta); };
    robot.start = {{grid.width() - robot.start.position.x(), robot.start.position.y()},
                   mirror(robot.start.theta)};
    robot.goal->position.x() = grid.width() - robot.goal->position.x();
    if (robot.goal->theta) robot.goal->theta = mirror(*robot.goal->theta);
    const double bound = bound_of(problem);
    ASSERT_NEAR(bound, bound_of(make_problem(mirrored, {robot})), 1e-5 * (1.0 + bound));
    around += bound > 1.01 * straight_bound_of(problem) ? 1 : 0;
  }
  EXPECT_GT(around, 50);
}

TEST(TautPathBounds, DoNotIncreaseWhereObstaclesAreRemoved) {
  const std::uint64_t seed = 61;
  support::Dice dice(seed);
  int decreased = 0;
  for (int k = 0; k < 400; ++k) {
    SCOPED_TRACE(testing::Message() << "seed " << seed << ", problem " << k);
    const Problem problem = support::random_problem(dice, 1);
    if (!problem.robots()[0].goal) continue;
    const PlanOptions options = support::random_options(dice, problem);
    if (!cost_alone(problem, options)) continue;  // without a path the bound is the straight line
    if (!fits_at_start(Instance(problem, options, StopCondition::never()), 0)) continue;  // likewise
    const OccupancyGrid& grid = problem.grid();
    OccupancyGrid fewer(grid.columns(), grid.rows(), grid.resolution());
    for (int row = 0; row < grid.rows(); ++row) {
      for (int column = 0; column < grid.columns(); ++column) {
        if (grid.blocked({column, row}) && dice.chance(0.8)) fewer.block({column, row});
      }
    }
    const double before = bound_of(problem, options);
    const double after = bound_of(make_problem(fewer, problem.robots()), options);
    ASSERT_LE(after, before + 1e-5 * (1.0 + before));
    decreased += after < before - 1e-3 ? 1 : 0;
  }
  EXPECT_GT(decreased, 25);
}

TEST(TautPathBounds, AreStraightLinesAndReportedAsCutOffWhenStopped) {
  const Problem problem =
      make_problem(wall(), {robot_at(1.5, 1.5).to(5.5, 1.5), robot_at(0.5, 3.5).to(5.5, 3.5)});
  const Instance instance(problem, {}, StopCondition::never());
  const TautPathBounds bounds(instance, {0, 1}, {kForever, kForever}, met());
  EXPECT_TRUE(bounds.cut_off());
  EXPECT_EQ(bounds[0], straight_bound(instance, 0));
  EXPECT_FALSE(TautPathBounds(instance, {1}, {kForever, kForever}, met()).cut_off())
      << "its goal is in sight";
}

TEST(TautPathBounds, AreZeroForRobotsThatWereNotRequested) {
  const Problem problem = make_problem(wall(), {robot_at(1.5, 1.5).to(5.5, 1.5), robot_at(0.5, 3.5)});
  const Instance instance(problem, {}, StopCondition::never());
  EXPECT_EQ(TautPathBounds(instance, {0}, {kForever, kForever}, StopCondition::never())[1], 0.0);
}

TEST(TautPathBounds, TakeLimitedWorkForManyRobotsOnALargeMapWithManyCorners) {
  support::Dice dice(67);
  OccupancyGrid grid(400, 400, 1.0);
  for (int k = 0; k < 16000; ++k) grid.block({dice.below(400), dice.below(400)});
  std::vector<Robot> robots;
  for (int row = 1; row < 399; row += 10) {
    const Cell from{2, row};
    const Cell to{397, 398 - row};
    if (grid.blocked(from) || grid.blocked(to)) continue;
    const Position a = grid.center(from);
    const Position b = grid.center(to);
    robots.push_back(robot_at(a.x(), a.y()).to(b.x(), b.y()).radius(0.3 + 1e-3 * row / 10));
  }
  const Problem problem = make_problem(grid, robots);
  const Instance instance(problem, {}, StopCondition::never());
  std::vector<std::size_t> all(instance.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  const TautPathBounds bounds(instance, all, std::vector<double>(instance.size(), kForever),
                              StopCondition::never());
  EXPECT_FALSE(bounds.cut_off());
  CornerVisibility corners(grid, 0.3, 0.4, StopCondition::never());
  for (const std::size_t robot : {std::size_t{0}, all.back()}) {
    TautPathSearch search(corners, instance.sight_past_walls(), instance.body(robot).wall_radius);
    const double whole = search
                             .run(legs_of(instance.itinerary(robot))[0], instance.body(robot), kForever,
                                  1'000'000'000, StopCondition::never())
                             .seconds;
    EXPECT_LT(bounds[robot], whole - 1e-3);
    EXPECT_GE(bounds[robot], straight_bound(instance, robot));
  }
}

/// A robot from the left of the wall to its right, and on to the last goal; 1 m/s.
Robot around_the_wall_and_back() {
  Robot robot = robot_at(0.5, 0.5).to(0.5, 0.5);
  robot.via = {{{6.5, 0.5}, {}, 2.0}};
  return robot;
}

TEST(TautPathBounds, AddUpTheLegsBetweenGoalsAndTheServices) {
  const double there = bound_of(make_problem(wall(), {robot_at(0.5, 0.5).to(6.5, 0.5)}));
  const Problem problem = make_problem(wall(), {around_the_wall_and_back()});
  const double bound = bound_of(problem);
  EXPECT_GT(bound, straight_bound_of(problem) + 1.0);
  EXPECT_GT(bound, there + 2.0 + 6.0);
  EXPECT_LE(bound, *cost_alone(problem));
  EXPECT_NEAR(bound_of(problem, {}, *cost_alone(problem)), bound, 1e-9) << "also where a plan is known";
}

TEST(TautPathBounds, BeginAfterTheCommittedActions) {
  Robot robot = robot_at(0.5, 0.5).to(6.5, 0.5);
  const double at_once = bound_of(make_problem(wall(), {robot}));
  robot.committed = {{Action::Type::wait, 0.0, 3.0, robot.start, robot.start}};
  const Problem problem = make_problem(wall(), {robot});
  EXPECT_NEAR(bound_of(problem), 3.0 + at_once, 1e-9);
  EXPECT_LE(bound_of(problem), *cost_alone(problem));
}

TEST(TautPathSearch, ReturnsHigherBoundsAfterMoreWork) {
  const Problem problem = make_problem(maze(), {robot_at(1.5, 0.5).to(1.5, 8.5)});
  const Instance instance(problem, {}, StopCondition::never());
  double before = straight_bound(instance, 0);
  const double first = before;
  for (const std::int64_t work : {0, 400, 1200, 1000000}) {
    CornerVisibility corners(problem.grid(), instance.body(0).wall_radius, instance.body(0).wall_radius,
                             StopCondition::never());
    TautPathSearch search(corners, instance.sight_past_walls(), instance.body(0).wall_radius);
    const TautPathResult result = search.run(legs_of(instance.itinerary(0))[0], instance.body(0), kForever,
                                             work, StopCondition::never());
    EXPECT_FALSE(result.cut_off);
    EXPECT_GT(result.seconds, before);
    before = result.seconds;
  }
  EXPECT_GT(before, 3.0 * first);
  EXPECT_NEAR(before, *cost_alone(problem), 0.05 * before);
}

TEST(TautPathSearch, NeedsLessWorkWhereAPlanIsKnown) {
  OccupancyGrid pillars(30, 30, 1.0);
  for (int row = 2; row < 30; row += 3) {
    for (int column = 2; column < 30; column += 3) pillars.block({column, row});
  }
  const Problem problem = make_problem(pillars, {robot_at(13.5, 14.5).to(19.5, 14.5)});
  const Instance instance(problem, {}, StopCondition::never());
  const double radius = instance.body(0).wall_radius;
  const auto work = [&](double max_seconds) {
    CornerVisibility corners(problem.grid(), radius, radius, StopCondition::never());
    TautPathSearch search(corners, instance.sight_past_walls(), radius);
    search.run(legs_of(instance.itinerary(0))[0], instance.body(0), max_seconds, 1'000'000,
               StopCondition::never());
    return search.work();
  };
  EXPECT_LT(work(*cost_alone(problem)), 0.8 * static_cast<double>(work(kForever)));
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
