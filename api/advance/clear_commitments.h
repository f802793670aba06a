#pragma once

#include <vector>

#include "core/model/robot.h"
#include "core/runtime/work.h"

namespace fleetplan::api {

/// Ends committed actions early, so that every robot may stay for ever where its commitment ends: none meets
/// another one, nor passes where another one has ended. Whatever becomes of the plans behind the commitments,
/// nobody then drives into a robot that stands. Robots are only stopped while they drive; a wait stays
/// committed. `inflation`: metres that planning adds to the radii, besides their vicinity. Ends early when
/// the stop is met.
void clear_commitments(std::vector<core::Robot>& robots, double inflation, core::Work& stop);

}  // namespace fleetplan::api
