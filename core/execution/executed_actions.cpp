#include "core/execution/executed_actions.h"

namespace fleetplan::core {

std::vector<Actions> executed_actions(const std::vector<Robot>& robots, const std::vector<RobotPlan>& plans) {
  std::vector<Actions> executed(robots.size());
  for (std::size_t k = 0; k < robots.size(); ++k) {
    if (!robots[k].invalid) executed[k] = robots[k].committed;
  }
  for (const RobotPlan& plan : plans) executed[plan.robot] = plan.actions;
  return executed;
}

double planned_time(Actions actions, std::size_t action, double fraction) {
  const Action& planned = actions[action];
  return fraction >= 1.0 ? planned.t_end : planned.t_start + fraction * (planned.t_end - planned.t_start);
}

}  // namespace fleetplan::core
