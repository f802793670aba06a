#pragma once

#include "api/request/limits.h"

namespace fleetplan::fuzz {

/// Limits above the seed inputs that an input of a few kilobytes can still exceed.
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
