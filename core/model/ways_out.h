#pragma once

// Zones that are blocked: the maps of robots with these zones. Robots inside zones that they may leave, and
// goals there.

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/position.h"
#include "core/map/static_map.h"
#include "core/model/robot.h"
#include "core/model/surroundings.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// The static maps of each robot: the map of the request, with the zones that are blocked for the robot.
/// Another map leaves out the zones that it may leave. Robots with the same zones share their maps.
class ZoneMaps {
 public:
  /// Makes the maps of so many robots. `map` is not null. If `stop` is met first, the object is not
  /// finished() and must not be used.
  ZoneMaps(std::shared_ptr<const StaticMap> map, const std::vector<Zone>& zones, std::size_t robots,
           const StopCondition& stop);

  bool finished() const { return finished_; }

  /// The map without zones; never null.
  const std::shared_ptr<const StaticMap>& map() const { return maps_.front(); }
  const std::shared_ptr<const StaticMap>& of(std::size_t robot) const {
    return map_of_.empty() ? maps_.front() : maps_[map_of_[robot]];
  }
  /// The map without the zones that the robot may leave, for a robot that leaves.
  const std::shared_ptr<const StaticMap>& while_leaving(std::size_t robot) const {
    return leaving_map_of_.empty() ? of(robot) : maps_[leaving_map_of_[robot]];
  }
  /// Whether there are zones that this robot may leave.
  bool may_leave_any(std::size_t robot) const {
    return !leaving_map_of_.empty() && leaving_map_of_[robot] != map_of_[robot];
  }

 private:
  std::vector<std::shared_ptr<const StaticMap>> maps_;  // the first one has no zones
  std::vector<std::size_t> map_of_;                     // by robot; empty if no zone is blocked
  std::vector<std::size_t> leaving_map_of_;             // by robot; empty if no zone may be left
  bool finished_ = true;
};

/// Returns the distance of a position from a zone, metres; 0 inside.
double distance_to_zone(const Zone& zone, const Position& position);

/// The zone nearest to a position, among the zones that are blocked like a wall or may be left.
struct NearestZone {
  std::size_t index = 0;
  double distance = 0.0;  // metres
};
std::optional<NearestZone> nearest_blocked_zone(const std::vector<Zone>& zones, std::size_t robot,
                                                const Position& position, double reach);
std::optional<NearestZone> nearest_zone_to_leave(const std::vector<Zone>& zones, std::size_t robot,
                                                 const Position& position, double reach);

/// The goals of a robot that are put off until a zone is open again: the first goal inside, and all goals
/// after it.
struct PostponedGoals {
  std::size_t first = 0;  // number of the goal that is inside
  std::size_t count = 0;  // of goals that are put off
  std::size_t zone = 0;   // index of a zone that it is inside of
};

/// How zones that may be left change the planning of one robot.
struct Leaving {
  std::optional<PostponedGoals> postponed = {};
  /// Places on the shortest way out of all such zones, from where the robot's plan begins. The beginning is
  /// left out. Each place is straight ahead of the place before, and only the last one is clear of the zones.
  /// Empty if the robot is not inside, stays, or has no way out.
  std::vector<Position> way_out = {};
};

/// Finds, for each robot, what zones that may be left change; an empty list if there are no such zones.
/// Removes the goals that are put off from the robots.
///
/// - A robot inside that has no goals left gets the end of its way out as its last goal.
/// - A robot outside that has no goals left has none, or yields if it has served goals before.
///
/// `inflation`: metres. Ends early when `stop` is met; then the result must not be used.
std::vector<Leaving> find_ways_out(const ZoneMaps& maps, const std::vector<Zone>& zones, double inflation,
                                   std::vector<Robot>& robots, const StopCondition& stop);

}  // namespace fleetplan::core
