#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/geometry/position.h"
#include "core/geometry/speed_profile.h"

namespace fleetplan::core {

/// One rotation, translation or wait of a robot, from one pose to another. The speed is constant or follows a
/// profile. Times are in seconds from the start of the plan.
struct Action {
  enum class Type { rotate, translate, wait };
  Type type = Type::wait;
  double t_start = 0.0;
  double t_end = 0.0;
  Pose from;
  Pose to;
  /// The goal (see Robot::goal_at) that is served during this wait, or whose `not_before` the robot waits
  /// for. nullopt for other waits and actions.
  std::optional<std::size_t> goal = {};
  /// Whether the robot translates backwards: the heading is opposite to the direction of motion.
  bool reverse = false;
  /// How the speed changes, if the robot's acceleration is limited. Forwards and backwards > 0. nullopt:
  /// constant speed.
  std::optional<SpeedProfile> profile = {};
};

/// Actions one after the other.
using ActionSequence = std::vector<Action>;

/// Returns what an action covers: metres of a translation, radians of a rotation.
double amount_of(const Action& action);

/// Returns the length (or angle) that the profile would cover in the action's time. The action has a profile.
double covered_by_profile(const Action& action);
/// Returns whether an action's profile is possible and covers the action's length (or angle) in its time,
/// within the contact tolerance. The action has a profile.
bool profile_fits(const Action& action);

/// The share of its length (or angle), in [0, 1], that an action covers in the share `elapsed` of its
/// duration.
double share_covered(const Action& action, double elapsed);

/// The share of an action, in [0, 1], that is covered at time `t`. 1 if the action takes no time.
double share_at(const Action& action, double t);
/// The inverse: the time at which a share in [0, 1] is covered.
double time_at_share(const Action& action, double share);
/// The speed at a time within an action, metres (or radians) per second, >= 0.
double speed_at(const Action& action, double t);

}  // namespace fleetplan::core
