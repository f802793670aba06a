#pragma once

// What is checked, and by which rules.

#include <cstdint>
#include <optional>
#include <vector>

#include "core/map/occupancy_grid.h"
#include "core/model/moving_obstacle.h"
#include "core/model/plan.h"
#include "core/model/robot.h"
#include "core/model/zone.h"
#include "core/verify/tolerances.h"

namespace fleetplan::core {

/// The map, the robots, the moving obstacles and the zones of a request. They need not form a valid Problem.
struct CheckedFleet {
  const OccupancyGrid& grid;
  const std::vector<Robot>& robots;
  const std::vector<MovingObstacle>& obstacles;
  const std::vector<Zone>* zones = nullptr;  // null: none
};

/// Whether a plan may end with goals left, because it ends at or after the horizon.
enum class GoalsLeft : std::uint8_t { none, allowed };

/// The rules beside those that hold for all plans. The default is the plainest check.
struct CheckRules {
  std::vector<Tolerance> tolerances;  // by robot
  /// Metres added to all radii, for robots against robots and walls, except while they execute commitments.
  double inflation = 0.0;
  double interval_margin = 0.0;   // seconds, see PlanOptions
  double wait_before_move = 0.0;  // seconds: every translation follows a stand-still of this duration
  /// Metres: so much may robots overlap each other or a wall at their start, inflation included.
  double start_overlap = 0.0;
  /// Seconds: a plan that ends at this time or later may end anywhere, with goals left. nullopt: all plans
  /// lead to the goal.
  std::optional<double> horizon = {};
  /// Committed actions must be repeated to the last digit. Otherwise the tolerances apply.
  bool exact_commitments = false;
  /// Collisions that are allowed: of exactly this pair, during the one uninterrupted overlap that contains
  /// Meeting::t (of the bare disks; contact counts).
  std::vector<Meeting> exempt = {};
};

}  // namespace fleetplan::core
