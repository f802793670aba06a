#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "core/geometry/polygon.h"
#include "core/geometry/position.h"
#include "core/geometry/segment.h"
#include "core/geometry/speed_profile.h"
#include "core/model/action.h"
#include "core/model/loads.h"
#include "core/model/robot.h"
#include "core/model/surroundings.h"

namespace fleetplan::core {

/// How one robot may drive in its zones of the types speed and one_way. A speed zone that is slower than the
/// robot is a slow zone. Only the open inside of a zone counts, up to kSamePosition.
class DriveZones {
 public:
  /// A piece of a straight move with one greatest speed. Without a profile, the robot drives at this speed.
  struct Piece {
    Segment path;
    double linear_speed = 0.0;  // metres per second
    double begin = 0.0;         // seconds from the beginning of the move
    double end = 0.0;
    std::optional<SpeedProfile> profile = {};
  };

  /// The zones for `robot`, which has this index, while it carries this load. Without a load: its first load.
  DriveZones(const std::vector<Zone>& zones, std::size_t index, const Robot& robot, const Load& load);
  DriveZones(const std::vector<Zone>& zones, std::size_t index, const Robot& robot)
      : DriveZones(zones, index, robot, first_load(robot)) {}
  /// Returns these zones while the robot carries another load. Both objects share their polygons.
  DriveZones with(const Load& load) const;

  bool empty() const { return speed_.empty() && one_way_->empty(); }
  bool limit_speeds() const { return !speed_.empty(); }

  /// Returns the index of a one-way zone that forbids the straight move; none if the move is allowed.
  std::optional<std::size_t> forbidding_zone(const Position& from, const Position& to) const;
  bool allow(const Position& from, const Position& to) const { return !forbidding_zone(from, to); }

  /// Returns the pieces of a straight move of length > 0, from rest to rest, at the greatest speeds; at least
  /// one piece. Neighbouring pieces differ in speed.
  std::vector<Piece> pieces(const Position& from, const Position& to) const;
  /// Returns the seconds that the straight move takes at the greatest speeds.
  double translation_time(const Position& from, const Position& to) const;

  /// Returns the index of a zone whose rule an action breaks by more than contact; none if no rule is broken.
  /// For example, the action translates against the zone's direction or is faster than the zone allows.
  std::optional<std::size_t> broken_by(const Action& action) const;

  /// The greatest linear speed at a position, metres per second.
  double linear_speed_at(const Position& position) const;
  /// The greatest angular speed at a position, radians per second.
  double angular_speed_at(const Position& position) const;
  /// The least angular speed at any position, radians per second.
  double least_angular_speed() const { return least_angular_speed_; }

 private:
  /// A zone as it is given.
  struct Area {
    std::size_t index = 0;
    Polygon polygon;
    Zone limits;  // without its polygon
  };
  struct SpeedZone {
    const Area* area = nullptr;
    double linear_speed = 0.0;
    double angular_speed = 0.0;
  };
  struct OneWayZone {
    std::size_t index = 0;
    Polygon polygon;
    double heading = 0.0;
    double half_angle = 0.0;
  };

  struct Speeds {
    double linear;
    double angular;
  };

  bool meets_speed_zone(const Position& from, const Position& to) const;
  Speeds speeds_at(const Position& position) const;

  void take(const Load& load);

  double linear_speed_ = 0.0;
  double angular_speed_;
  Inertia linear_inertia_;
  double least_angular_speed_ = 0.0;
  std::shared_ptr<const std::vector<Area>> areas_;  // of the type speed
  std::vector<SpeedZone> speed_;                    // the zones that are slower than the robot
  std::shared_ptr<const std::vector<OneWayZone>> one_way_;
};

}  // namespace fleetplan::core
