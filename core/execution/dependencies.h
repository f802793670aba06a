#pragma once

// Dependencies between robots, by which they can execute a plan at their own pace. The idea is from action
// dependency graphs (Hoenig et al., RA-L 2019) and RMTRACK (Cap, Gregoire, Frazzoli, IROS 2016). Here, it is
// for any-angle motion in continuous time (docs/proofs.md, Dependencies).

#include <compare>
#include <cstddef>
#include <optional>
#include <vector>

#include "core/model/plan.h"
#include "core/model/robot.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// How far a robot is in its actions. It has executed all actions before this one, and this one up to the
/// fraction (in [0, 1], of its length, angle or duration).
struct ActionProgress {
  std::size_t robot = 0;   // index into the problem's robots
  std::size_t action = 0;  // index into its actions
  double fraction = 0.0;
};

/// A place in a robot's actions. All actions before this one are executed, and this one up to the fraction.
struct ActionPlace {
  std::size_t action = 0;
  double fraction = 0.0;

  auto operator<=>(const ActionPlace&) const = default;  // NOLINT(modernize-use-nullptr): its own 0
};

/// The place of a progress. Between two actions, it is before the later one rather than after the earlier
/// one.
inline ActionPlace place_of(const ActionProgress& progress) {
  if (progress.fraction < 1.0) return {progress.action, progress.fraction};
  return {progress.action + 1, 0.0};
}

/// One robot waits for another: the robot of `gate` may reach the progress `gate`. It may not pass it until
/// the robot of `until` has reached the progress `until`.
struct Dependency {
  ActionProgress gate;
  ActionProgress until;
  double slack = 0.0;  // seconds: the planned time of `gate` minus the planned time of `until`
};

/// Two robots that the plan leads past each other with less slack than required. Keeping the order is not
/// enough for them: they have to keep the clock.
struct TightPair {
  std::size_t first = 0;
  std::size_t second = 0;  // > first
  double t = 0.0;          // seconds; when the slack is least
  double slack = 0.0;      // seconds; 0 if they are nearer than they should be
};

struct Dependencies {
  std::vector<Dependency> list;  // by the planned time of the gates
  std::vector<TightPair> tight;  // by time
};

struct DependencyRules {
  std::vector<double> margins;  // by robot: metres, >= 0, added to its radius
  double slack = 0.1;           // seconds, > 0: the least planned time between `until` and `gate`
  double tolerance = 0.0;       // metres: how much the disks of the plan may overlap
};

/// The limits of an answer. Dependencies and tight pairs together: kDependenciesOfAny, plus
/// kDependenciesOfAnAction for each action, and never more than kMaxDependencies. Robots that follow each
/// other closely and slowly would have millions.
inline constexpr std::size_t kDependenciesOfAny = 10'000;
inline constexpr std::size_t kDependenciesOfAnAction = 100;
inline constexpr std::size_t kMaxDependencies = 250'000;
/// The limit of dependencies that are found, including dependencies that others imply.
inline constexpr std::size_t kMaxFound = 1'000'000;

/// Returns the dependencies of a valid plan. Suppose that `tight` is empty, and that robots execute their own
/// actions in order and obey the dependencies, at any speed and with any stops. Then:
///
/// - Robots keep the sum of their radii and margins, minus the tolerance, from each other.
/// - If every robot that may go on does so, all arrive.
///
/// Dependencies that others imply are left out. Vicinities do not count, because they are distances for
/// robots that are on time. Returns none if the stop condition is met, or if there are too many dependencies.
std::optional<Dependencies> make_dependencies(const std::vector<Robot>& robots,
                                              const std::vector<RobotPlan>& plans,
                                              const DependencyRules& rules, const StopCondition& stop);

/// The same, but returns none if the memory of the job does not suffice, either.
std::optional<Dependencies> dependencies_in_memory(const std::vector<Robot>& robots,
                                                   const std::vector<RobotPlan>& plans,
                                                   const DependencyRules& rules, const StopCondition& stop);

}  // namespace fleetplan::core
