#pragma once

// What single robots contribute to the objective that is minimized.

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

/// The share of a robot in the objective, weighted seconds. With the objective `tardiness`, a small part of
/// its cost is included, which decides between plans that are equally late. For the makespan it is the share
/// in the flowtime, which counts among plans of the same makespan.
double share_of(const Itinerary& itinerary, PlanOptions::Objective objective, const Trajectory& trajectory);

/// A lower bound of the share of every trajectory that costs at least so many seconds.
double least_share(const Itinerary& itinerary, PlanOptions::Objective objective, double cost);

/// The cost from which on no trajectory has a share below `share`, seconds: the inverse of least_share().
double cost_with_share(const Itinerary& itinerary, PlanOptions::Objective objective, double share);

/// The value of the objective, by the estimates where plans stop at the horizon: the weighted sum of costs,
/// the greatest cost, or the weighted sum of delays. Robots without a way to their goals are left out.
double objective_value(const Plan& plan, const std::vector<Robot>& robots, PlanOptions::Objective objective);

}  // namespace fleetplan::core
