#pragma once

#include <vector>

#include "core/execution/executed_actions.h"
#include "core/model/robot.h"

namespace fleetplan::core {

/// What a wait is for. The rest of it only gives way to others, or keeps to the clock.
struct WaitPurpose {
  double least = 0.0;       // seconds: a service, or a wait that was added before a translation
  double not_before = 0.0;  // seconds: these do not begin earlier
};

/// By action; of actions that do not wait, nothing. `wait_before_move`: of PlanOptions, seconds; 0 if added
/// waits may be shortened. A service at the end of a longer added wait counts towards it.
std::vector<WaitPurpose> wait_purposes(const Robot& robot, Actions actions, double wait_before_move);

}  // namespace fleetplan::core
