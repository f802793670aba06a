#pragma once

// What a robot has to do, as far as its policy may not change it.

#include <cstddef>
#include <vector>

#include "core/execution/simulation/disturbance.h"
#include "core/model/plan.h"
#include "core/model/robot.h"

namespace fleetplan::core {

/// What a wait is for. The rest of it only gives way to others, or keeps to the clock.
struct WaitPurpose {
  double least = 0.0;       // seconds: a service, or a wait that was added before a translation
  double not_before = 0.0;  // seconds: these do not begin earlier
};

/// By action; of actions that do not wait, nothing. `wait_before_move`: of
/// PlanOptions, seconds; 0 if added waits may be shortened.
std::vector<WaitPurpose> wait_purposes(const Robot& robot, const std::vector<Action>& actions,
                                       double wait_before_move);

/// A part of an action that takes a fixed time: it leads from the end of the part before to this fraction of
/// the action, at constant speed, or the robot stands if that is the same.
struct Phase {
  double seconds = 0.0;
  double to_fraction = 0.0;
};

/// The phases of a rotation or translation, after its start delay: it moves and halts in turn.
std::vector<Phase> moving_phases(const DisturbedActions& disturbed, std::size_t action);

}  // namespace fleetplan::core
