#pragma once

#include <cstddef>
#include <vector>

#include "core/model/plan_options.h"
#include "core/model/problem.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// The previous plans that hold together.
struct KeptPlans {
  std::vector<bool> kept;  // by robot; empty if no robot has a previous plan
  bool cut_off = false;    // the check was not finished, so none is kept

  bool contains(std::size_t robot) const { return !kept.empty() && kept[robot]; }
};

/// Judges the previous plans by the checker under the options' inflation, interval margin, added waits and
/// start overlap. If some violate the rules, those that do so on their own are left out, and then of two that
/// conflict the one with the lower priority. What becomes of a robot that is left out is not known yet, so
/// it conflicts with no plan here. A robot without a previous plan, or with an empty one, has one without
/// actions; this holds if it is at rest at its last goal. Takes as long as a check of the plans.
KeptPlans keep_previous_plans(const Problem& problem, const PlanOptions& options, const StopCondition& stop);

}  // namespace fleetplan::core
