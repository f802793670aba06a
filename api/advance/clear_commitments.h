#pragma once

#include <vector>

#include "api/json/parse_stop.h"
#include "core/model/robot.h"

namespace fleetplan::api {

/// How a robot deviates from the plan that the others' commitments rely on.
enum class Deviation {
  none,
  moves,   // later or elsewhere than planned; for as long as it is committed
  stands,  // at the end of its commitment, until the others' commitments end
};

/// Ends the committed actions of robots where they touch a robot that deviates or whose own commitment was
/// ended: nobody drives into a robot that is held. `deviations`: by robot; one that stands keeps its
/// commitment. Ends early when the stop is met.
void clear_commitments(std::vector<core::Robot>& robots, std::vector<Deviation> deviations, ParseStop& stop);

}  // namespace fleetplan::api
