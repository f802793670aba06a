#pragma once

// What each robot contributes to the objective that is minimized.

#include <optional>
#include <vector>

#include "core/model/itinerary.h"
#include "core/model/plan.h"
#include "core/model/plan_options.h"
#include "core/model/robot.h"
#include "core/model/trajectory.h"

namespace fleetplan::core {

/// Seconds by which a visit to this goal is late; none if the goal is not due.
std::optional<double> late_by(const Goal& goal, double t_arrive);

/// The share of a robot in the objective, in weighted seconds.
///
/// - Objective `tardiness`: the share includes a small part of the robot's cost. This part decides between
///   plans that are equally late.
/// - Objective `makespan`: the share in the flowtime. It decides between plans of the same makespan.
double share_of(const Itinerary& itinerary, PlanOptions::Objective objective, const Trajectory& trajectory);

/// A lower bound of the share of any trajectory whose cost is at least so many seconds.
double least_share(const Itinerary& itinerary, PlanOptions::Objective objective, double cost);

/// The cost, seconds, from which on no trajectory has a share below `share`. The inverse of least_share().
double cost_with_share(const Itinerary& itinerary, PlanOptions::Objective objective, double share);

/// The value of the objective: the weighted sum of costs, the greatest cost, or the weighted sum of delays.
/// Plans that stop at the horizon count with their estimates. Robots without a way to their goals are left
/// out.
double objective_value(const Plan& plan, const std::vector<Robot>& robots, PlanOptions::Objective objective);

}  // namespace fleetplan::core
