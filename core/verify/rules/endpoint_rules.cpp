#include "core/verify/rules/endpoint_rules.h"

#include <cmath>
#include <optional>
#include <string>

#include "core/geometry/angle.h"
#include "core/verify/quantity_text.h"

namespace fleetplan::core {
namespace {

/// Compares a pose with the required one. The detail begins with `what` and names the required pose `which`.
std::optional<Violation> check_pose(const Violation& blank, const Pose& pose, const Goal& required,
                                    const Tolerance& tolerance, const std::string& what,
                                    const std::string& which) {
  Violation violation = blank;
  const double away = (pose.position - required.position).norm();
  if (away > tolerance.metres) {
    violation.distance = away;
    violation.detail = what + " " + metres(away) + " from the robot's " + which;
    return violation;
  }
  const double turn = required.theta ? std::abs(rotation_between(pose.theta, *required.theta)) : 0.0;
  if (turn > tolerance.radians) {
    violation.distance = turn;
    violation.detail = what + " with a heading " + radians(turn) + " from that of the robot's " + which;
    return violation;
  }
  return std::nullopt;
}

}  // namespace

std::vector<Violation> check_endpoints(const Robot& robot, const RobotPlan& plan, const Tolerance& tolerance,
                                       GoalsLeft goals_left) {
  std::vector<Violation> violations;
  const bool stays = plan.actions.empty();
  if (!stays) {
    const Violation blank{Violation::Kind::wrong_start, {plan.robot}, 0.0, 0.0, 0.0, "", {}};
    const Goal start{robot.start.position, robot.start.theta};
    const auto wrong =
        check_pose(blank, plan.actions.front().from, start, tolerance, "the plan starts", "start");
    if (wrong) violations.push_back(*wrong);
  }
  if (goals_left == GoalsLeft::allowed) return violations;
  const Violation blank{
      Violation::Kind::wrong_goal, {plan.robot}, stays ? 0.0 : plan.actions.back().t_end, 0.0, 0.0, "", {}};
  const Pose& rest = stays ? robot.start : plan.actions.back().to;
  const Goal required = robot.goal.value_or(Goal{robot.committed_end().position, std::nullopt});
  const std::string place = robot.goal ? "goal" : "start, where it is parked";
  const auto wrong = check_pose(blank, rest, required, tolerance, "the plan ends", place);
  if (wrong) violations.push_back(*wrong);
  return violations;
}

}  // namespace fleetplan::core
