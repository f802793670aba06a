#pragma once

#include <fleetplan/pose.h>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace fleetplan {

/// A disk that the planner does not control, for example a person or a robot of another fleet. It is absent
/// before the first entry, moves straight at constant speed from entry to entry, and then leaves or stays. It
/// may cross walls, the edge of the map and other obstacles.
struct MovingObstacle {
  struct Entry {
    double t = 0.0;  // seconds, >= 0, strictly ascending
    Position position;
  };

  std::string id;             // for your own use
  double radius = 0.0;        // metres, > 0
  std::vector<Entry> motion;  // at least one
  bool stays = false;         // it stays after the last entry instead of leaving
};

/// A part of the map with a rule of its own.
struct Zone {
  enum class Type {
    blocked,  // no part of a robot's disk may be inside
    speed,    // limits of the speeds while the robot's centre is inside
    one_way,  // translations with the centre inside keep within `half_angle` of `heading`
  };

  std::string id;  // for your own use
  Type type = Type::blocked;
  /// The corners of a simple polygon, at least three, in either order. The border belongs to a blocked zone,
  /// but not to other zones. Sides that cross are not detected: it is then undefined which points are inside.
  std::vector<Position> polygon;
  /// The limits of a zone of the type `speed`. None: the zone does not limit this speed.
  std::optional<double> linear_speed;   // metres per second
  std::optional<double> angular_speed;  // radians per second
  double heading = 0.0;                 // for `one_way`: radians
  double half_angle = 0.0;              // for `one_way`: radians, > 0, at most pi
  std::vector<std::size_t> robots;      // the robots that it is for; empty: all robots
};

}  // namespace fleetplan
