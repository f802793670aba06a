#pragma once

// What robots must ask of each other so that they can execute a plan at their own pace: the idea of action
// dependency graphs (Hoenig et al., RA-L 2019) and of RMTRACK (Cap, Gregoire, Frazzoli, IROS 2016), for
// any-angle motion in continuous time (docs/method.md, Dependencies).

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

/// There are at most so many dependencies (and tight pairs) as this and so many more for each action; and at
/// most so many in all. Robots that follow each other closely and slowly would have millions.
inline constexpr std::size_t kDependenciesOfAny = 10'000;
inline constexpr std::size_t kDependenciesOfAnAction = 100;
inline constexpr std::size_t kMostDependencies = 250'000;
/// The limit of dependencies that are found, including those that others imply.
inline constexpr std::size_t kMostFound = 1'000'000;

/// The dependencies of a valid plan. Where `tight` is empty, robots that go along their own actions in order,
/// at any speed and with any stops, and obey, keep the sum of their radii and margins, less the tolerance;
/// and if everyone who may go on does, all arrive. A dependency that others imply is left out. Vicinities do
/// not count: they are distances for those in time. Nothing if the stop condition is met, or if there are too
/// many.
std::optional<Dependencies> make_dependencies(const std::vector<Robot>& robots,
                                              const std::vector<RobotPlan>& plans,
                                              const DependencyRules& rules, const StopCondition& stop);

}  // namespace fleetplan::core
