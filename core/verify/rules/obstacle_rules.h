#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "core/verify/check_rules.h"
#include "core/verify/execution/departure.h"
#include "core/verify/execution/execution.h"
#include "core/verify/geometry/obstacle_field.h"
#include "core/verify/verify.h"
#include "core/verify/violation_list.h"

namespace fleetplan::core {

/// The distance of a position from the nearest obstacle, at most `reach` metres.
double distance_from_walls(const ObstacleField& field, const Position& position, double reach);

/// The distance from obstacles that a robot has to keep during each of its legs, metres: its radius there,
/// and after its commitment the inflated one. A robot that begins nearer, as the rules allow, comes no nearer
/// than it is until a leg of it ends clear. `distance_from`: of a position from obstacles, at most the
/// second argument.
std::vector<double> distances_to_keep(const std::function<double(const Position&, double)>& distance_from,
                                      const std::vector<double>& radii, const std::vector<Leg>& legs,
                                      const Departure& departure, double tolerance, const CheckRules& rules);

/// Reports where a disk overlaps obstacles by more than the tolerance: one violation for each leg, or one for
/// consecutive legs through which the overlap continues. `legs` are a result of `execute`; `radii` are those
/// of the disk in each of them. Ends early when `stop` is met.
ViolationList check_obstacles(const ObstacleField& field, std::size_t robot, const std::vector<double>& radii,
                              const std::vector<Leg>& legs, double tolerance, const StopCondition& stop);

}  // namespace fleetplan::core
