#include "core/execution/wait_purposes.h"

#include <algorithm>
#include <cstddef>

namespace fleetplan::core {
namespace {

/// Whether the action is directly before a translation.
bool precedes_translation(Actions actions, std::size_t index) {
  return index + 1 < actions.size() && actions[index + 1].type == Action::Type::translate;
}

}  // namespace

std::vector<WaitPurpose> wait_purposes(const Robot& robot, Actions actions, double wait_before_move) {
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
    if (!precedes_translation(actions, k)) continue;
    const double added = std::min(planned, wait_before_move);
    if (added <= purpose.least) continue;
    purpose.not_before = std::max(0.0, purpose.not_before - (added - purpose.least));
    purpose.least = added;
  }
  return purposes;
}

}  // namespace fleetplan::core
