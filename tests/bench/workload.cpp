#include "tests/bench/workload.h"

#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <utility>

#include "core/runtime/random.h"

namespace fleetplan::bench {
namespace {

using core::Cell;
using core::Position;
using core::Random;

void add_rectangle(core::OccupancyGrid& grid, Random& random) {
  int columns = kRectangleLength;
  int rows = kRectangleWidth;
  if (random.below(2) == 1) std::swap(columns, rows);
  const auto first = [&](int cells, int length) {
    const int places = cells - length + 1;
    return static_cast<int>(random.below(static_cast<std::size_t>(places)));
  };
  const int left = first(grid.columns(), columns);
  const int bottom = first(grid.rows(), rows);
  for (int row = bottom; row < bottom + rows; ++row) {
    for (int column = left; column < left + columns; ++column) grid.block({column, row});
  }
}

/// Disks that must not overlap.
class Disks {
 public:
  bool fits(const Position& center, double radius) const {
    for (const auto& [other, other_radius] : disks_) {
      const double reach = radius + other_radius;
      if ((center - other).squaredNorm() < reach * reach) return false;
    }
    return true;
  }
  void add(const Position& center, double radius) { disks_.emplace_back(center, radius); }

 private:
  std::vector<std::pair<Position, double>> disks_;
};

/// Cells to draw from.
class Room {
 public:
  Room(const core::OccupancyGrid& grid, double radius)
      : grid_(grid), radius_(radius), cells_(largest_room(grid, radius)) {}

  /// The centre of a random cell where the disk overlaps no other; none if there is no such cell.
  std::optional<Position> draw(const Disks& others, Random& random) {
    for (std::size_t drawn = 0; drawn < cells_.size(); ++drawn) {
      std::swap(cells_[drawn], cells_[drawn + random.below(cells_.size() - drawn)]);
      const Position center = grid_.center(cells_[drawn]);
      if (others.fits(center, radius_)) return center;
    }
    return std::nullopt;
  }

 private:
  const core::OccupancyGrid& grid_;
  double radius_;
  std::vector<Cell> cells_;  // in any order
};

double heading(Random& random) { return std::numbers::pi * (1.0 - 2.0 * random.unit()); }  // (-pi, pi]

}  // namespace

Recipe empty_hall() { return {}; }

Recipe hall_with_rectangles() {
  Recipe recipe;
  recipe.name = "rects";
  recipe.rectangles = 10;
  return recipe;
}

Recipe crowd() {
  Recipe recipe;
  recipe.name = "crowd";
  recipe.side = 32;
  recipe.robots = 512;  // half the cells
  recipe.types = {{0.5, 1.0, 1000.0}};
  recipe.goal_headings = false;
  return recipe;
}

Recipe hall(const std::string& name, int side, std::size_t robots) {
  for (Recipe recipe : {empty_hall(), hall_with_rectangles(), crowd()}) {
    if (recipe.name != name) continue;
    const double area = std::pow(static_cast<double>(side) / recipe.side, 2);
    recipe.side = side;
    recipe.rectangles = static_cast<int>(std::lround(recipe.rectangles * area));
    recipe.robots = robots;
    return recipe;
  }
  throw std::runtime_error("there is no hall " + name);
}

std::vector<Cell> largest_room(const core::OccupancyGrid& grid, double radius) {
  const core::LineOfSight sight(grid, core::StopCondition::never());
  std::vector<char> seen(static_cast<std::size_t>(grid.cell_count()), 0);
  const auto is_new = [&](Cell cell) {
    if (!grid.inside(cell) || seen[grid.index(cell)] != 0) return false;
    seen[grid.index(cell)] = 1;
    return sight.disk_fits(grid.center(cell), radius);
  };
  std::vector<Cell> largest;
  for (int row = 0; row < grid.rows(); ++row) {
    for (int column = 0; column < grid.columns(); ++column) {
      std::vector<Cell> room;
      if (is_new({column, row})) room.push_back({column, row});
      for (std::size_t next = 0; next < room.size(); ++next) {
        const Cell at = room[next];
        for (const Cell cell : {Cell{at.column + 1, at.row}, Cell{at.column - 1, at.row},
                                Cell{at.column, at.row + 1}, Cell{at.column, at.row - 1}}) {
          if (is_new(cell)) room.push_back(cell);
        }
      }
      if (room.size() > largest.size()) largest = std::move(room);
    }
  }
  return largest;
}

Workload generate(const Recipe& recipe, std::uint64_t seed) {
  Random random(seed);
  Workload workload{core::OccupancyGrid(recipe.side, recipe.side, 1.0), {}};
  for (int i = 0; i < recipe.rectangles; ++i) add_rectangle(workload.grid, random);

  std::vector<Room> rooms;
  rooms.reserve(recipe.types.size());
  for (const RobotType& type : recipe.types) rooms.emplace_back(workload.grid, type.radius);
  Disks starts;
  Disks goals;
  while (workload.robots.size() < recipe.robots) {
    const std::size_t number = workload.robots.size();
    const RobotType& type = recipe.types[number % recipe.types.size()];
    Room& room = rooms[number % recipe.types.size()];
    const auto start = room.draw(starts, random);
    const auto goal = room.draw(goals, random);
    if (!start || !goal) break;
    starts.add(*start, type.radius);
    goals.add(*goal, type.radius);
    std::string id = std::to_string(number);
    id.insert(id.begin(), 'r');
    const double start_heading = heading(random);
    core::Goal to{*goal, {}};
    if (recipe.goal_headings) to.theta = heading(random);
    workload.robots.push_back({std::move(id), type.radius, type.linear_speed, type.angular_speed,
                               core::Pose{*start, start_heading}, to});
  }
  return workload;
}

}  // namespace fleetplan::bench
