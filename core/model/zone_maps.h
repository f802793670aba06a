#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "core/map/static_map.h"
#include "core/model/zone.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// The static maps of each robot: the map of the request, with the zones that are blocked for the robot, and
/// without those that it may leave. Robots with the same zones share theirs.
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
  /// For a robot that leaves: the map without the zones that it may leave.
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

/// The zone that is blocked like a wall, or that may be left, and is nearest to a position.
struct NearestZone {
  std::size_t index = 0;
  double distance = 0.0;  // metres
};
std::optional<NearestZone> nearest_blocked_zone(const std::vector<Zone>& zones, std::size_t robot,
                                                const Position& position, double reach);
std::optional<NearestZone> nearest_zone_to_leave(const std::vector<Zone>& zones, std::size_t robot,
                                                 const Position& position, double reach);

}  // namespace fleetplan::core
