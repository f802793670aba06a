#include "core/verify/rules/commitment_rules.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include "core/geometry/angle.h"
#include "core/verify/quantity_text.h"

namespace fleetplan::core {
namespace {

/// A number of an action, and that of the committed one.
struct Comparison {
  const char* what;
  double difference;
  double tolerance;
  const char* unit;
};

/// The first difference that is larger than its tolerance.
std::optional<Comparison> difference(const Action& action, const Action& committed,
                                     const Tolerance& tolerance) {
  const auto position = [](const Pose& a, const Pose& b) {
    return std::max(std::abs(a.position.x() - b.position.x()), std::abs(a.position.y() - b.position.y()));
  };
  const auto heading = [](const Pose& a, const Pose& b) {
    return a.theta == b.theta ? 0.0 : std::abs(rotation_between(a.theta, b.theta));
  };
  for (const Comparison& comparison :
       {Comparison{"begins", std::abs(action.t_start - committed.t_start), tolerance.seconds, "s"},
        Comparison{"ends", std::abs(action.t_end - committed.t_end), tolerance.seconds, "s"},
        Comparison{"begins", position(action.from, committed.from), tolerance.metres, "m"},
        Comparison{"ends", position(action.to, committed.to), tolerance.metres, "m"},
        Comparison{"begins with a heading", heading(action.from, committed.from), tolerance.radians, "rad"},
        Comparison{"ends with a heading", heading(action.to, committed.to), tolerance.radians, "rad"}}) {
    if (comparison.difference > comparison.tolerance) return comparison;
  }
  return std::nullopt;
}

}  // namespace

std::optional<Violation> check_commitments(const Robot& robot, const RobotPlan& plan,
                                           const Tolerance& tolerance, bool exact) {
  const Tolerance allowed = exact ? Tolerance{} : tolerance;
  Violation violation{Violation::Kind::committed_changed, {plan.robot}, 0.0, 0.0, 0.0, "", {}};
  for (std::size_t k = 0; k < robot.committed.size(); ++k) {
    const Action& committed = robot.committed[k];
    violation.t = committed.t_start;
    if (k >= plan.actions.size()) {
      violation.distance = static_cast<double>(plan.actions.size());
      violation.required = static_cast<double>(robot.committed.size());
      violation.detail = "the plan has " + std::to_string(plan.actions.size()) + " actions, but " +
                         std::to_string(robot.committed.size()) + " are committed";
      return violation;
    }
    const std::string action = "actions[" + std::to_string(k) + "]";
    if (plan.actions[k].type != committed.type) {
      violation.detail = action + " has another type than the committed action";
      return violation;
    }
    if (const auto changed = difference(plan.actions[k], committed, allowed)) {
      violation.distance = changed->difference;
      violation.detail = action + " " + changed->what + " " +
                         quantity_text(changed->difference, changed->unit) + " off the committed action";
      return violation;
    }
  }
  return std::nullopt;
}

}  // namespace fleetplan::core
