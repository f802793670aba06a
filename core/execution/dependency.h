#pragma once

// Dependencies between robots that execute a plan at their own pace.

#include <compare>
#include <cstddef>
#include <vector>

namespace fleetplan::core {

/// How far a robot is in its actions: it has executed this one up to the fraction (in [0, 1], of its length,
/// angle or duration), and all before it.
struct ActionProgress {
  std::size_t robot = 0;   // index into the problem's robots
  std::size_t action = 0;  // index into its actions
  double fraction = 0.0;
};

/// A place in a robot's actions: this one is executed up to the fraction, and all before it.
struct ActionPlace {
  std::size_t action = 0;
  double fraction = 0.0;

  auto operator<=>(const ActionPlace&) const = default;  // NOLINT(modernize-use-nullptr): its own 0
};

/// The place of a progress, which is before an action rather than after another.
inline ActionPlace place_of(const ActionProgress& progress) {
  if (progress.fraction < 1.0) return {progress.action, progress.fraction};
  return {progress.action + 1, 0.0};
}

/// One robot waits for another: the robot of `gate` may reach the progress `gate`, but may not pass it until
/// the robot of `until` has reached the progress `until`.
struct Dependency {
  ActionProgress gate;
  ActionProgress until;
  double slack = 0.0;  // seconds: the planned time of `gate` less that of `until`
};

/// Two robots that the plan leads past each other with less slack than required. Keeping the order does not
/// suffice for them: they have to keep the clock.
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

}  // namespace fleetplan::core
