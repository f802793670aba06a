#pragma once

// The plainest check of plans: without moving obstacles, zones and options.

#include <optional>
#include <vector>

#include "core/verify/verify.h"

namespace fleetplan::core {

inline std::optional<VerifyReport> verify(const OccupancyGrid& grid, const std::vector<Robot>& robots,
                                          const std::vector<RobotPlan>& plans,
                                          const std::vector<Tolerance>& tolerances,
                                          const StopCondition& stop) {
  const std::vector<MovingObstacle> none;
  CheckRules rules;
  rules.tolerances = tolerances;
  return verify({grid, robots, none}, plans, rules, stop);
}

/// With one tolerance for all robots, in metres, seconds and radians.
inline std::optional<VerifyReport> verify(const OccupancyGrid& grid, const std::vector<Robot>& robots,
                                          const std::vector<RobotPlan>& plans, double tolerance,
                                          const StopCondition& stop) {
  return verify(grid, robots, plans, std::vector(robots.size(), Tolerance::of_all(tolerance)), stop);
}

}  // namespace fleetplan::core
