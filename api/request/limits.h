#pragma once

#include <cstddef>
#include <cstdint>

namespace fleetplan::api {

/// What a single request may ask for. The defaults are the service's.
struct Limits {
  std::size_t max_body = 32u << 20;     // bytes, after decompression
  std::int64_t max_cells = 16'000'000;  // cells of the map
  std::size_t max_robots = 2000;
  // In total, wherever they are:
  std::size_t max_goals = 20'000;     // goals in lists `goals`
  std::size_t max_actions = 200'000;  // actions in `committed` and `previous`
  std::size_t max_obstacles = 2000;
  std::size_t max_obstacle_entries = 400'000;
  std::size_t max_zones = 1000;
  std::size_t max_zone_corners = 20'000;     // corners of polygons of zones
  std::size_t max_plan_memory = 256u << 20;  // bytes, for all that is made of a body
  int max_depth = 32;                        // nesting of the JSON
  std::int64_t default_budget_ms = 5000;     // budget of a request that names none
  std::int64_t max_budget_ms = 120'000;      // a longer one is clamped, with a warning
};

/// The most pairs of poses of one matrix, and of robots and tasks of one assignment.
inline constexpr std::size_t kMostPairs = 250'000;

}  // namespace fleetplan::api
