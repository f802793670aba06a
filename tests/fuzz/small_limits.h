#pragma once

#include "api/request/limits.h"

namespace fleetplan::fuzz {

/// As far beyond the seeds as an input of a few kilobytes gets, so that the limits are met as well.
inline api::Limits small_limits() {
  api::Limits limits;
  limits.max_cells = 1500;
  limits.max_robots = 12;
  limits.max_depth = 12;
  limits.default_budget_ms = 5;
  limits.max_budget_ms = 5;
  return limits;
}

}  // namespace fleetplan::fuzz
