#include "core/verify/execution/departure.h"

#include <cstddef>

namespace fleetplan::core {

Departure departure_of(const Robot& robot, const RobotPlan* plan) {
  Departure departure;
  if (!robot.invalid) departure.committed_until = robot.committed_until();
  if (plan == nullptr) return departure;
  for (std::size_t k = robot.committed.size(); k < plan->actions.size(); ++k) {
    const Action& action = plan->actions[k];
    if (action.type != Action::Type::translate || action.from.position == action.to.position) continue;
    departure.leaves = action.t_start;
    departure.first_move_ends = action.t_end;
    break;
  }
  return departure;
}

}  // namespace fleetplan::core
