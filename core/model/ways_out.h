#pragma once

// Robots inside of zones that they may leave, and goals there.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/position.h"
#include "core/model/robot.h"
#include "core/model/zone.h"
#include "core/model/zone_maps.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// The goals of a robot that are put off until a zone is open again: the first one that is inside, and those
/// that follow it.
struct PostponedGoals {
  std::size_t first = 0;  // number of the goal that is inside
  std::size_t count = 0;  // of goals that are put off
  std::size_t zone = 0;   // index of a zone that it is inside of
};

/// What zones that may be left change for one robot.
struct Leaving {
  std::optional<PostponedGoals> postponed = {};
  /// Places on the shortest way out of all such zones, from where the robot's plan begins, which is left out:
  /// each is straight ahead of the one before, and only the last one is clear of them. Empty if the robot is
  /// not inside, stays, or has no way out.
  std::vector<Position> way_out = {};
  /// Whether the last place of the way out stands in for the goals that are put off.
  bool rests_outside = false;
};

/// Finds what zones that may be left change for the robots, by robot; an empty list if there are no such
/// zones. Takes the goals that are put off away from the robots: one that is inside and has no goals left
/// gets the end of its way out as its goal, one outside has none. `inflation`: metres. Ends early when the
/// stop is met; then the result must not be used.
std::vector<Leaving> find_ways_out(const ZoneMaps& maps, const std::vector<Zone>& zones, double inflation,
                                   std::vector<Robot>& robots, const StopCondition& stop);

}  // namespace fleetplan::core
