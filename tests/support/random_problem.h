#pragma once

// Random maps, robots, problems and options for property tests.

#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/map/occupancy_grid.h"
#include "core/model/plan_options.h"
#include "core/model/problem.h"

namespace fleetplan::support {

/// Random values that depend only on the seed.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : engine_(seed) {}
  double between(double low, double high) { return low + (high - low) * unit(); }
  int below(int count) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(count)); }
  bool chance(double probability) { return unit() < probability; }

 private:
  double unit() { return static_cast<double>(engine_() >> 11) * 0x1.0p-53; }
  std::mt19937_64 engine_;
};

/// Returns a map of 8 to 32 cells a side, 0 to 30 % of them blocked, with a resolution of 0.05 to 2 m.
inline core::OccupancyGrid random_map(Dice& dice) {
  const double resolution = std::vector<double>{0.05, 0.5, 1.0, 2.0}[static_cast<std::size_t>(dice.below(4))];
  core::OccupancyGrid grid(8 + dice.below(25), 8 + dice.below(25), resolution);
  const double density = dice.chance(0.3) ? 0.0 : dice.between(0.0, 0.3);
  for (int row = 0; row < grid.rows(); ++row) {
    for (int column = 0; column < grid.columns(); ++column) {
      if (dice.chance(density)) grid.block({column, row});
    }
  }
  return grid;
}

/// Returns up to `count` robots with radii of 0.1 to 3 cells, speeds over a factor of 20, and poses on and
/// off the cell centres. Some are parked, some have a goal without a heading.
inline std::vector<core::Robot> random_robots(Dice& dice, const core::OccupancyGrid& grid, int count) {
  std::vector<core::Robot> robots;
  const auto free_place = [&](double radius, auto&& taken) -> std::optional<core::Position> {
    for (int attempt = 0; attempt < 30; ++attempt) {
      core::Position p(dice.between(0.0, grid.width()), dice.between(0.0, grid.height()));
      if (dice.chance(0.5)) p = grid.center(grid.cell_at(p));
      if (core::obstacle_distance(grid, p, radius) >= radius && !taken(p)) return p;
    }
    return std::nullopt;
  };
  for (int i = 0; i < count; ++i) {
    core::Robot robot;
    robot.id = std::to_string(i);
    robot.radius = grid.resolution() * (dice.chance(0.2) ? dice.between(1.0, 3.0) : dice.between(0.1, 1.0));
    robot.linear_speed = grid.resolution() * std::pow(20.0, dice.between(-0.5, 0.5));
    robot.angular_speed = dice.chance(0.1) ? 1000.0 : std::pow(20.0, dice.between(-0.5, 0.5));
    const auto start = free_place(robot.radius, [&](const core::Position& p) {
      for (const auto& other : robots) {
        if ((p - other.start.position).norm() < robot.radius + other.radius) return true;
      }
      return false;
    });
    if (!start) continue;
    robot.start = {*start, dice.between(-std::numbers::pi, std::numbers::pi)};
    const auto goal = free_place(robot.radius, [&](const core::Position& p) {
      for (const auto& other : robots) {
        if (other.goal && (p - other.goal->position).norm() < robot.radius + other.radius) return true;
      }
      return false;
    });
    if (goal && !dice.chance(0.1)) {
      robot.goal = core::Goal{*goal, std::nullopt};
      if (dice.chance(0.7)) robot.goal->theta = dice.between(-std::numbers::pi, std::numbers::pi);
    }
    robots.push_back(robot);
  }
  return robots;
}

/// Returns a valid problem with 1 to `count` robots.
inline core::Problem random_problem(Dice& dice, int count) {
  while (true) {
    core::OccupancyGrid grid = random_map(dice);
    std::vector<core::Robot> robots = random_robots(dice, grid, count);
    if (robots.empty()) continue;
    auto problem = core::Problem::create(std::move(grid), std::move(robots), core::StopCondition::never());
    if (auto* valid = std::get_if<core::Problem>(&problem)) return std::move(*valid);
  }
}

/// Returns random values for all options.
inline core::PlanOptions random_options(Dice& dice, const core::Problem& problem) {
  using Options = core::PlanOptions;
  Options options;
  options.seed = static_cast<std::uint64_t>(dice.below(1000));
  options.priority = static_cast<Options::Priority>(dice.below(4));
  options.reordering = static_cast<Options::Reordering>(dice.below(3));
  options.objective = static_cast<Options::Objective>(dice.below(2));
  options.mode = dice.chance(0.3) ? Options::Mode::anytime : Options::Mode::first;
  options.max_iterations = 5;
  options.any_angle = dice.chance(0.7);
  options.smoothing = options.seed % 5 != 0;
  options.connectivity = 4 << dice.below(4);
  if (dice.chance(0.3)) options.start_safe_interval = dice.between(0.0, 10.0);
  if (dice.chance(0.3)) options.inflation = problem.grid().resolution() * dice.between(0.0, 0.5);
  if (dice.chance(0.3)) options.wait_before_move = dice.between(0.0, 3.0);
  return options;
}

}  // namespace fleetplan::support
