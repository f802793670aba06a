#include "tests/bench/workload.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <utility>

#include "core/map/occupancy_grid.h"
#include "core/model/problem.h"
#include "tests/support/ascii_map.h"

namespace fleetplan::bench {
namespace TEST_FILE {

constexpr std::uint64_t kSeeds = 5;

/// Calls check(workload, recipe) for both halls of a few seeds.
template <class Check>
void for_each_workload(Check&& check) {
  for (const Recipe& recipe : {empty_hall(), hall_with_rectangles()}) {
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      SCOPED_TRACE(recipe.name + ", seed " + std::to_string(seed));
      check(generate(recipe, seed), recipe);
    }
  }
}

/// A number that changes with every pose and blocked cell.
double fingerprint(const Workload& workload) {
  double sum = 0.0;
  double weight = 1.0;
  for (const core::Robot& robot : workload.robots) {
    for (const double value : {robot.start.position.x(), robot.start.position.y(), robot.start.theta,
                               robot.goal->position.x(), robot.goal->position.y(), *robot.goal->theta}) {
      sum += weight * value;
      weight += 1.0;
    }
  }
  for (int row = 0; row < workload.grid.rows(); ++row) {
    for (int column = 0; column < workload.grid.columns(); ++column) {
      if (workload.grid.blocked({column, row})) sum += 1000.0 * column + row;
    }
  }
  return sum;
}

int blocked_cells(const core::OccupancyGrid& grid) {
  int count = 0;
  for (int row = 0; row < grid.rows(); ++row) {
    for (int column = 0; column < grid.columns(); ++column) count += grid.blocked({column, row}) ? 1 : 0;
  }
  return count;
}

TEST(Workload, DependsOnlyOnItsSeed) {
  for (const Recipe& recipe : {empty_hall(), hall_with_rectangles()}) {
    EXPECT_EQ(fingerprint(generate(recipe, 7)), fingerprint(generate(recipe, 7)));
    EXPECT_NE(fingerprint(generate(recipe, 7)), fingerprint(generate(recipe, 8)));
  }
}

TEST(Workload, StaysTheSameFromVersionToVersion) {
  EXPECT_NEAR(fingerprint(generate(empty_hall(), 1)), 34850914.834429555, 1e-6);
  EXPECT_NEAR(fingerprint(generate(hall_with_rectangles(), 1)), 46537955.315872505, 1e-6);
}

TEST(Workload, WithFewerRobotsHasTheFirstRobotsOfTheLarger) {
  Recipe fewer = hall_with_rectangles();
  fewer.robots = 90;
  Workload larger = generate(hall_with_rectangles(), 3);
  larger.robots.resize(fewer.robots);
  EXPECT_EQ(fingerprint(generate(fewer, 3)), fingerprint(larger));
}

TEST(Hall, HasAsManyRectanglesPerCellAtAnotherSize) {
  const Recipe recipe = hall("rects", 128, 15);
  EXPECT_EQ(recipe.name, "rects");
  EXPECT_EQ(recipe.side, 128);
  EXPECT_EQ(recipe.rectangles, 40);
  EXPECT_EQ(recipe.robots, 15u);
  EXPECT_EQ(hall("rects", 32, 15).rectangles, 3);
  EXPECT_EQ(hall("empty", 128, 15).rectangles, 0);
}

TEST(Workload, OfACrowdHasDistinctCellsForDisksAsWideAsOne) {
  const Workload workload = generate(hall("crowd", 32, 320), 1);
  ASSERT_EQ(workload.robots.size(), 320u);
  std::set<std::pair<double, double>> starts;
  std::set<std::pair<double, double>> goals;
  for (const core::Robot& robot : workload.robots) {
    EXPECT_EQ(robot.radius, 0.5);
    EXPECT_EQ(robot.angular_speed, 1000.0);
    EXPECT_FALSE(robot.goal->theta);
    starts.emplace(robot.start.position.x(), robot.start.position.y());
    goals.emplace(robot.goal->position.x(), robot.goal->position.y());
  }
  EXPECT_EQ(starts.size(), 320u);
  EXPECT_EQ(goals.size(), 320u);
  EXPECT_TRUE(std::holds_alternative<core::Problem>(
      core::Problem::create(workload.grid, workload.robots, core::StopCondition::never())));
}

TEST(Workload, HasThePapersMapAndThreeTypesInTurn) {
  for_each_workload([](const Workload& workload, const Recipe&) {
    EXPECT_EQ(workload.grid.columns(), 64);
    EXPECT_EQ(workload.grid.rows(), 64);
    EXPECT_EQ(workload.grid.resolution(), 1.0);
    ASSERT_EQ(workload.robots.size(), 300u);
    const std::pair<double, double> types[] = {{0.3, 1.5}, {0.5, 1.0}, {1.0, 0.5}};
    std::set<std::string> ids;
    for (std::size_t i = 0; i < workload.robots.size(); ++i) {
      const core::Robot& robot = workload.robots[i];
      EXPECT_EQ(std::pair(robot.radius, robot.linear_speed), types[i % 3]);
      EXPECT_EQ(robot.angular_speed, std::numbers::pi);
      ids.insert(robot.id);
    }
    EXPECT_EQ(ids.size(), workload.robots.size());
  });
}

TEST(Workload, MakesAValidProblem) {
  for_each_workload([](const Workload& workload, const Recipe&) {
    const auto problem = core::Problem::create(workload.grid, workload.robots, core::StopCondition::never());
    EXPECT_TRUE(std::holds_alternative<core::Problem>(problem));
  });
}

TEST(Workload, HasNoOverlappingStartsOrGoals) {
  for_each_workload([](const Workload& workload, const Recipe&) {
    double smallest_gap = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < workload.robots.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const core::Robot& a = workload.robots[i];
        const core::Robot& b = workload.robots[j];
        const double starts = (a.start.position - b.start.position).norm();
        const double goals = (a.goal->position - b.goal->position).norm();
        smallest_gap = std::min(smallest_gap, std::min(starts, goals) - a.radius - b.radius);
      }
    }
    EXPECT_GE(smallest_gap, 0.0);
  });
}

TEST(Workload, PlacesStartsAndGoalsInTheLargestRoomForTheRobot) {
  for_each_workload([](const Workload& workload, const Recipe&) {
    for (const double radius : {0.3, 0.5, 1.0}) {
      const auto room = largest_room(workload.grid, radius);
      std::set<std::pair<double, double>> centers;
      for (const core::Cell cell : room) {
        const core::Position center = workload.grid.center(cell);
        centers.emplace(center.x(), center.y());
        EXPECT_GE(core::obstacle_distance(workload.grid, center, 2.0), radius - 1e-9);
      }
      for (const core::Robot& robot : workload.robots) {
        if (robot.radius != radius) continue;
        EXPECT_TRUE(centers.contains({robot.start.position.x(), robot.start.position.y()}));
        EXPECT_TRUE(centers.contains({robot.goal->position.x(), robot.goal->position.y()}));
      }
    }
  });
}

TEST(Workload, HasHeadingsInAllDirections) {
  for_each_workload([](const Workload& workload, const Recipe&) {
    std::array<int, 4> quadrants{};
    for (const core::Robot& robot : workload.robots) {
      for (const double theta : {robot.start.theta, *robot.goal->theta}) {
        ASSERT_GT(theta, -std::numbers::pi);
        ASSERT_LE(theta, std::numbers::pi);
        ++quadrants[static_cast<std::size_t>((theta + std::numbers::pi) / (std::numbers::pi / 2)) % 4];
      }
    }
    // 600 headings, 150 to a quadrant, standard deviation 10.6.
    for (const int count : quadrants) EXPECT_NEAR(count, 150, 50);
  });
}

TEST(Workload, HasTenRectanglesOrNone) {
  for_each_workload([](const Workload& workload, const Recipe& recipe) {
    const int blocked = blocked_cells(workload.grid);
    if (recipe.rectangles == 0) {
      EXPECT_EQ(blocked, 0);
    } else {
      EXPECT_GT(blocked, 10 * 40 / 2) << "they overlap only here and there";
      EXPECT_LE(blocked, 10 * 40);
    }
  });
}

TEST(Workload, PlacesRectanglesInsideTheMapInBothOrientations) {
  Recipe recipe;
  recipe.rectangles = 1;
  recipe.robots = 0;
  recipe.side = 20;  // as long as the rectangle, so that it must reach from edge to edge
  int horizontal = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const core::OccupancyGrid grid = generate(recipe, seed).grid;
    EXPECT_EQ(blocked_cells(grid), 40);
    bool row_full = false;
    for (int row = 0; row < 20; ++row)
      row_full = row_full || (grid.blocked({0, row}) && grid.blocked({19, row}));
    horizontal += row_full ? 1 : 0;
  }
  EXPECT_GT(horizontal, 5);
  EXPECT_LT(horizontal, 35);
}

TEST(Workload, EndsWhereTheMapIsFull) {
  Recipe recipe;
  recipe.side = 6;
  recipe.robots = 100;
  const Workload workload = generate(recipe, 1);
  EXPECT_GT(workload.robots.size(), 5u);
  EXPECT_LT(workload.robots.size(), 36u);
  EXPECT_TRUE(std::holds_alternative<core::Problem>(
      core::Problem::create(workload.grid, workload.robots, core::StopCondition::never())));
}

TEST(LargestRoom, IsConnectedAndExcludesSmallerRooms) {
  const core::OccupancyGrid grid = support::ascii_map({"..#....",  //
                                                       "..#....",  //
                                                       "..##...",  //
                                                       ".#.#..."});
  EXPECT_EQ(largest_room(grid, 0.5).size(), 14u);
}

TEST(LargestRoom, CountsOnlyCellsWhereTheDiskFits) {
  const core::OccupancyGrid grid = support::ascii_map({".....",  //
                                                       ".....",  //
                                                       "....."});
  EXPECT_EQ(largest_room(grid, 0.5).size(), 15u);
  EXPECT_EQ(largest_room(grid, 0.6).size(), 3u);
  EXPECT_TRUE(largest_room(grid, 1.6).empty());
}

TEST(LargestRoom, DoesNotConnectDiagonalCells) {
  const core::OccupancyGrid grid = support::ascii_map({"..##",  //
                                                       "..##",  //
                                                       "##..",  //
                                                       "##.."});
  EXPECT_EQ(largest_room(grid, 0.5).size(), 4u);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::bench
