#pragma once

#include "core/plan/planner.h"
#include "tests/support/expect_bounds.h"
#include "tests/support/expect_safe.h"

namespace fleetplan::support {

/// Returns the plan of the facade. Expects that the checker accepts it and that its bounds hold.
inline core::Plan plan_checked(const core::Problem& problem, const core::PlanOptions& options = {}) {
  core::Plan plan = core::plan(problem, options, core::StopCondition::never());
  expect_safe(problem, plan, options);
  expect_bounded(plan);
  return plan;
}

}  // namespace fleetplan::support
