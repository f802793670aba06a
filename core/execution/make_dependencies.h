#pragma once

// Dependencies between robots, by which they can execute a plan at their own pace: the idea of action
// dependency graphs (Hoenig et al., RA-L 2019) and of RMTRACK (Cap, Gregoire, Frazzoli, IROS 2016), for
// any-angle motion in continuous time (docs/proofs.md, Dependencies).

#include <cstddef>
#include <optional>
#include <vector>

#include "core/execution/dependency.h"
#include "core/model/plan.h"
#include "core/model/robot.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

struct DependencyRules {
  std::vector<double> margins;  // by robot: metres, >= 0, added to its radius
  double slack = 0.1;           // seconds, > 0: the least planned time between `until` and `gate`
  double tolerance = 0.0;       // metres: how much the disks of the plan may overlap
};

/// The limits of an answer: kDependenciesOfAny dependencies and tight pairs together, kDependenciesOfAnAction
/// more for each action, and never more than kMostDependencies. Robots that follow each other closely and
/// slowly would have millions.
inline constexpr std::size_t kDependenciesOfAny = 10'000;
inline constexpr std::size_t kDependenciesOfAnAction = 100;
inline constexpr std::size_t kMostDependencies = 250'000;
/// The limit of dependencies that are found, including those that others imply.
inline constexpr std::size_t kMostFound = 1'000'000;

/// Returns the dependencies of a valid plan. If `tight` is empty, robots that execute their own actions in
/// order, at any speed and with any stops, and obey the dependencies keep the sum of their radii and margins,
/// less the tolerance, from each other; and if every robot that may go on does so, all arrive. Dependencies
/// that others imply are left out. Vicinities do not count, as they are distances for robots that are on
/// time. Returns none if the stop condition is met, or if there are too many dependencies.
std::optional<Dependencies> make_dependencies(const std::vector<Robot>& robots,
                                              const std::vector<RobotPlan>& plans,
                                              const DependencyRules& rules, const StopCondition& stop);

}  // namespace fleetplan::core
