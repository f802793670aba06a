#pragma once

// Whom robots wait for in a plan, by its dependencies.

#include <cstddef>
#include <optional>
#include <vector>

#include "core/execution/dependencies.h"
#include "core/model/plan.h"
#include "core/model/robot.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Whom a robot waits for in one of its actions.
struct WaitReason {
  /// The most robots of one wait: an answer names them, and stays linear in its actions.
  static constexpr std::size_t kMaxRobots = 3;

  std::size_t action = 0;
  std::vector<std::size_t> robots;  // the one whose passage ends the wait first, then those before it
};

/// Returns by robot the waits that end when others have passed, by ascending actions. Without such a wait, or
/// the part of it that is no service and no added wait, the robot would be at a gate before another robot has
/// left it, or less than `margin` (seconds, PlanOptions::interval_margin) after it. Gates beyond the next
/// such wait do not count, as that one ends for them. `wait_before_move`: PlanOptions, seconds. Returns none
/// if `stop` is met first.
std::optional<std::vector<std::vector<WaitReason>>> wait_reasons(const std::vector<Robot>& robots,
                                                                 const std::vector<RobotPlan>& plans,
                                                                 const Dependencies& dependencies,
                                                                 double wait_before_move, double margin,
                                                                 const StopCondition& stop);

}  // namespace fleetplan::core
