#pragma once

#include <vector>

#include "core/map/occupancy_grid.h"
#include "core/model/plan.h"
#include "core/model/robot.h"

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

/// By robot, the tolerances for a plan of the planner: contact, and what doubles lose in coordinates of the
/// map's size and, at the robot's own speed, in times as long as its own plan's. For robots with actions of
/// the request, kMostTolerance.
std::vector<Tolerance> plan_tolerances(const OccupancyGrid& grid, const std::vector<Robot>& robots,
                                       const std::vector<RobotPlan>& plans);

}  // namespace fleetplan::core
