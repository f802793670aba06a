#include "core/execution/simulation/course.h"

#include <algorithm>

namespace fleetplan::core {
namespace {

/// Whether the action is directly before a translation.
bool precedes_translation(const std::vector<Action>& actions, std::size_t index) {
  return index + 1 < actions.size() && actions[index + 1].type == Action::Type::translate;
}

}  // namespace

std::vector<WaitPurpose> wait_purposes(const Robot& robot, const std::vector<Action>& actions,
                                       double wait_before_move) {
  std::vector<WaitPurpose> purposes(actions.size());
  for (std::size_t k = 0; k < actions.size(); ++k) {
    const Action& action = actions[k];
    if (action.type != Action::Type::wait) continue;
    const double planned = action.t_end - action.t_start;
    WaitPurpose& purpose = purposes[k];
    if (action.goal && *action.goal < robot.goal_count()) {
      const Goal& goal = robot.goal_at(*action.goal);
      purpose.least = std::min(planned, goal.service);
      purpose.not_before = std::min(goal.not_before, action.t_end - purpose.least);
    }
    if (precedes_translation(actions, k)) {
      purpose.least = std::max(purpose.least, std::min(planned, wait_before_move));
    }
  }
  return purposes;
}

std::vector<Phase> moving_phases(const DisturbedActions& disturbed, std::size_t action) {
  const double moving = disturbed.actions[action].moving;
  std::vector<Phase> phases;
  double moved = 0.0;
  double fraction = 0.0;
  for (const DisturbedActions::Halt& halt : disturbed.halts(action)) {
    fraction = halt.after / moving;
    phases.push_back({halt.after - moved, fraction});
    phases.push_back({halt.seconds, fraction});
    moved = halt.after;
  }
  phases.push_back({moving - moved, 1.0});
  return phases;
}

}  // namespace fleetplan::core
