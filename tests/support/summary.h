#pragma once

// Plans and reports as text, for failure messages and comparisons.

#include <cstddef>
#include <iomanip>
#include <sstream>
#include <string>

#include "core/model/plan.h"
#include "core/verify/verify.h"

namespace fleetplan::support {

/// Returns all parts of the plan that must be the same to the last bit when it is computed again.
inline std::string exact_text(const core::Plan& plan) {
  std::ostringstream text;
  text << std::hexfloat;
  for (const auto& robot : plan.plans) {
    text << "robot " << robot.robot << " cost " << robot.cost << " bound " << robot.lower_bound << '\n';
    for (const auto& action : robot.actions) {
      text << "  " << static_cast<int>(action.type) << ' ' << action.t_start << ' ' << action.t_end << ' '
           << action.to.position.x() << ' ' << action.to.position.y() << ' ' << action.to.theta << '\n';
    }
  }
  for (const auto& robot : plan.unplanned) {
    text << "unplanned " << robot.robot << ' ' << static_cast<int>(robot.reason) << '\n';
  }
  return text.str();
}

inline std::string text(const core::VerifyReport& report) {
  std::ostringstream text;
  for (const auto& violation : report.violations) {
    text << "t = " << violation.t << ", robot";
    for (const std::size_t robot : violation.robots) text << ' ' << robot;
    text << ": " << violation.detail << '\n';
  }
  return text.str();
}

}  // namespace fleetplan::support
