#pragma once

// Random zones for property tests.

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/model/problem.h"
#include "tests/support/random_problem.h"

namespace fleetplan::support {

/// Returns a polygon of three to eight corners around a place of the map, convex or star-shaped.
inline std::vector<core::Position> random_polygon(Dice& dice, const core::OccupancyGrid& grid) {
  const core::Position centre(dice.between(0.0, grid.width()), dice.between(0.0, grid.height()));
  const double size = grid.resolution() * dice.between(1.0, 6.0);
  const int corners = 3 + dice.below(6);
  const bool is_star = dice.chance(0.3);
  const double first = dice.between(0.0, 2.0 * std::numbers::pi);
  std::vector<core::Position> polygon;
  for (int k = 0; k < corners; ++k) {
    const double angle = first + 2.0 * std::numbers::pi * k / corners;
    const double away = size * (is_star ? dice.between(0.3, 1.0) : 1.0);
    polygon.push_back(centre + away * core::Position(std::cos(angle), std::sin(angle)));
  }
  if (dice.chance(0.2)) {  // along the lines of the grid
    const auto along = [&](double x) { return grid.resolution() * std::round(x / grid.resolution()); };
    const core::Position low(along(centre.x()), along(centre.y()));
    const core::Position size_of_box =
        grid.resolution() * core::Position(1.0 + dice.below(6), 1.0 + dice.below(6));
    polygon = {low, low + core::Position(size_of_box.x(), 0.0), low + size_of_box,
               low + core::Position(0.0, size_of_box.y())};
  }
  return polygon;
}

/// Returns one to six zones of random types, some of them for some robots only.
inline std::vector<core::Zone> random_zones(Dice& dice, const core::Problem& problem,
                                            const std::vector<core::Zone::Type>& types) {
  std::vector<core::Zone> zones;
  for (int k = 1 + dice.below(6); k > 0; --k) {
    core::Zone zone;
    zone.id = "zone " + std::to_string(k);
    zone.type = types[static_cast<std::size_t>(dice.below(static_cast<int>(types.size())))];
    zone.polygon = random_polygon(dice, problem.grid());
    if (zone.type == core::Zone::Type::speed) {
      const core::Robot& robot = problem.robots().front();
      if (dice.chance(0.8)) zone.linear_speed = robot.linear_speed * dice.between(0.2, 1.2);
      if (dice.chance(0.3)) zone.linear_speed_share = dice.between(0.2, 1.2);
      if (dice.chance(0.5)) zone.angular_speed = robot.angular_speed * dice.between(0.2, 1.2);
    }
    if (zone.type == core::Zone::Type::one_way) {
      zone.heading = dice.between(-std::numbers::pi, std::numbers::pi);
      if (dice.chance(0.5)) zone.heading = 0.5 * std::numbers::pi * (dice.below(4) - 1);
      zone.half_angle = dice.chance(0.3) ? 0.5 * std::numbers::pi : dice.between(0.1, 2.5);
    }
    for (std::size_t robot = 0; robot < problem.robots().size() && dice.chance(0.5); ++robot) {
      if (dice.chance(0.5)) zone.robots.push_back(robot);
    }
    zones.push_back(zone);
  }
  return zones;
}

/// Returns a valid problem with 1 to `count` robots, and zones of these types.
inline core::Problem random_problem_with_zones(Dice& dice, int count,
                                               const std::vector<core::Zone::Type>& types) {
  while (true) {
    const core::Problem plain = random_problem(dice, count);
    core::ProblemConditions conditions;
    conditions.zones = random_zones(dice, plain, types);
    auto problem = core::Problem::create(plain.map(), plain.robots(), std::move(conditions),
                                         core::StopCondition::never());
    if (auto* valid = std::get_if<core::Problem>(&problem)) return std::move(*valid);
  }
}

}  // namespace fleetplan::support
