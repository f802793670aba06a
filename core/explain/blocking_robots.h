#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/fleet/plan_state.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Finds the robots that keep a robot from its goal. The effort for all calls together is limited, to about a
/// tenth of a second.
class BlockingRobots {
 public:
  /// The arguments outlive this object.
  BlockingRobots(PlanState& state, const StopCondition& stop) : state_(state), stop_(stop) {}

  /// Returns the robots that keep `robot` from its goal, ascending. The robot stays at its start and has no
  /// path among the others, or follows a trajectory that gains nothing. Afterwards, it still does so.
  ///
  /// The search begins with the robots that conflict with the robot's path alone on the map. It removes one
  /// after the other, as long as ignoring the rest still gives the robot a path, or a path that gains
  /// something. Returns more robots than necessary if the effort or `stop` ends this early; none if `stop` is
  /// met already.
  std::vector<std::size_t> find(std::size_t robot);

 private:
  PlanState& state_;
  const StopCondition& stop_;
  std::int64_t expansions_ = 0;
};

}  // namespace fleetplan::core
