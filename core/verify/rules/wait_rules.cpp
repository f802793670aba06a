#include "core/verify/rules/wait_rules.h"

#include <cmath>
#include <cstddef>
#include <string>

#include "core/geometry/angle.h"
#include "core/verify/quantity_text.h"

namespace fleetplan::core {
namespace {

constexpr std::size_t kBetweenPolls = 64;

bool goes_on_straight(const Action& before, const Action& action, const Tolerance& tolerance) {
  if (before.type != Action::Type::translate) return false;
  if (action.t_start - before.t_end > tolerance.seconds) return false;
  if (std::abs(rotation_between(before.to.theta, action.from.theta)) > tolerance.radians) return false;
  const Position earlier = before.to.position - before.from.position;
  const Position later = action.to.position - action.from.position;
  return earlier.dot(later) >= 0.0;  // not back
}

}  // namespace

ViolationList check_waits(const Robot& robot, const RobotPlan& plan, double wait, const Tolerance& tolerance,
                          const StopCondition& stop) {
  ViolationList violations;
  if (wait <= 0.0) return violations;
  const std::vector<Action>& actions = plan.actions;
  // Since when the robot stands, and whether possibly since before t = 0.
  double since = 0.0;
  bool open = !robot.committed.empty() && !actions.empty() && actions.front().type == Action::Type::wait;
  for (std::size_t k = 0; k < actions.size(); ++k) {
    if (k % kBetweenPolls == 0 && stop.met()) break;
    const Action& action = actions[k];
    if (action.type == Action::Type::wait) continue;
    const double stood = action.t_start - since;
    const bool judged = action.type == Action::Type::translate && k >= robot.committed.size() && !open &&
                        (k == 0 || !goes_on_straight(actions[k - 1], action, tolerance));
    if (judged && stood < wait - tolerance.seconds) {
      violations.add({Violation::Kind::speed,
                      {plan.robot},
                      action.t_start,
                      stood,
                      wait,
                      "actions[" + std::to_string(k) + "] follows a stand-still of " + seconds(stood) +
                          ", but robots wait " + seconds(wait) + " before they move",
                      {}});
    }
    since = action.t_end;
    open = false;
  }
  return violations;
}

}  // namespace fleetplan::core
