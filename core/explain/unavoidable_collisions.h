#pragma once

#include <span>
#include <vector>

#include "core/model/itinerary.h"
#include "core/model/plan.h"
#include "core/model/problem.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// The collisions that no plan avoids: bare disks in certain motion that overlap by more than
/// kContactTolerance and rounding.
struct UnavoidableCollisions {
  /// By time. Each uninterrupted overlap counts once. For each robot, the first kMaxUnavoidableOfRobot.
  std::vector<UnavoidableCollision> collisions;
  /// By robot: whether something collides with it at the place where it stays. Empty if there are no
  /// collisions.
  std::vector<bool> while_staying;
  bool finished = true;  // false when the stop condition was met first; then there may be more
};

/// Finds the collisions of certain motion. Certain are
///
/// - moving obstacles,
/// - the committed motion of robots,
/// - and the stay of robots that are not `planned` (by robot) at their committed end.
///
/// Committed motion against committed motion is left out, because it is clear in a valid problem.
/// `itineraries` belong to the problem's robots. The effort is nearly linear in the request.
UnavoidableCollisions unavoidable_collisions(const Problem& problem, std::span<const Itinerary> itineraries,
                                             const std::vector<bool>& planned, const StopCondition& stop);

}  // namespace fleetplan::core
