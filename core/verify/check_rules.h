#pragma once

// The input of a check: the fleet, the rules and the tolerances.

#include <cstdint>
#include <optional>
#include <vector>

#include "core/geometry/moving_obstacle.h"
#include "core/map/occupancy_grid.h"
#include "core/model/plan.h"
#include "core/model/robot.h"
#include "core/model/zone.h"

namespace fleetplan::core {

/// How much the plan of one robot may deviate. Two disks may overlap by the larger one of their tolerances.
struct Tolerance {
  double metres = 0.0;
  double seconds = 0.0;
  double radians = 0.0;

  static Tolerance of_all(double tolerance) { return {tolerance, tolerance, tolerance}; }
};

/// No tolerance in metres exceeds this, whatever a request contains; also the default of POST /v1/validate.
inline constexpr double kMostTolerance = 1e-6;

/// Returns by robot the tolerances for a plan of the planner: contact, and what doubles lose in coordinates
/// of the map's size and, at the robot's own speed, in times as long as its own plan's. For robots with
/// actions of the request, kMostTolerance.
std::vector<Tolerance> plan_tolerances(const OccupancyGrid& grid, const std::vector<Robot>& robots,
                                       const std::vector<RobotPlan>& plans);

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
  /// Metres by which robots may overlap each other or a wall at their start, inflation included.
  double start_overlap = 0.0;
  /// Seconds: a plan that ends at this time or later may end anywhere, with goals left. nullopt: all plans
  /// lead to the goal.
  std::optional<double> horizon = {};
  /// Committed actions must be repeated to the last digit. Otherwise the tolerances apply.
  bool exact_commitments = false;
  /// Unavoidable collisions that are allowed: of exactly the pair of each collision, during the one
  /// uninterrupted overlap that contains UnavoidableCollision::t (of the bare disks; contact counts).
  std::vector<UnavoidableCollision> exempt = {};
};

}  // namespace fleetplan::core
