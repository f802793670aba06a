#pragma once

#include <optional>
#include <vector>

#include "core/model/surroundings.h"
#include "core/runtime/stop_condition.h"
#include "core/verify/check_rules.h"
#include "core/verify/execution.h"

namespace fleetplan::core {

/// The collisions of robots with each other and with moving obstacles.
struct PairReport {
  ViolationList violations;
  std::optional<double> min_clearance;  // see VerifyReport
};

/// Checks robots against robots, also with the interval margin, and against moving obstacles. Returns none if
/// `stop` is met first.
std::optional<PairReport> check_pairs(const ExecutedFleet& fleet,
                                      const std::vector<MovingObstacle>& obstacles, const CheckRules& rules,
                                      const StopCondition& stop);

}  // namespace fleetplan::core
