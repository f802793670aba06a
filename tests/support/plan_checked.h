#pragma once

#include "core/plan/planner.h"
#include "tests/support/expect_bounds.h"
#include "tests/support/expect_safe.h"

namespace fleetplan::support {

/// Expects that no method has served more robots than it was to plan.
inline void expect_counted(const core::Plan& plan) {
  for (const core::MethodCounts& counts : plan.search.moves) {
    EXPECT_GE(counts.served, 0);
    EXPECT_GE(counts.could_not_serve, 0);
    EXPECT_LE(counts.served + counts.could_not_serve, counts.tried);
  }
}

/// Returns the plan of the facade. Expects that the checker accepts it, and that its bounds and counts hold.
inline core::Plan plan_checked(const core::Problem& problem, const core::PlanOptions& options = {}) {
  core::Plan plan = core::plan(problem, options, core::StopCondition::never());
  expect_safe(problem, plan, options);
  expect_bounded(plan);
  expect_counted(plan);
  return plan;
}

}  // namespace fleetplan::support
