#pragma once

// What surrounds the robots, beside the walls of the map: moving obstacles and zones.

#include <algorithm>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "core/geometry/position.h"

namespace fleetplan::core {

/// A disk that the planner does not control, for example a person or a robot of another fleet. It is absent
/// before the first entry, moves straight at constant speed from entry to entry, and then stays or vanishes.
/// It also occupies its place in the instant when it appears or vanishes. It may cross walls, the edge of the
/// map and other obstacles.
struct MovingObstacle {
  struct Entry {
    double t = 0.0;  // seconds, >= 0, strictly ascending
    Position position{0.0, 0.0};
  };
  enum class After { leaves, stays };

  std::string id;
  double radius = 0.0;        // metres, > 0
  std::vector<Entry> motion;  // one entry at least
  After after = After::leaves;
};

/// A part of the map with a rule of its own.
struct Zone {
  enum class Type {
    blocked,  // no part of a robot's disk may be inside
    speed,    // limits of the speeds while the robot's centre is inside
    one_way,  // translations with the centre inside keep within `half_angle` of `heading`
  };
  static constexpr double kNoLimit = std::numeric_limits<double>::infinity();

  std::string id;
  Type type = Type::blocked;
  /// A simple polygon: at least three corners in order, map frame, metres. The border belongs to a blocked
  /// zone, but not to other zones.
  std::vector<Position> polygon = {};
  double linear_speed = kNoLimit;        // for `speed`: metres per second, > 0
  double linear_speed_share = kNoLimit;  // for `speed`: share of the robot's own linear speed, > 0
  double angular_speed = kNoLimit;       // for `speed`: radians per second, > 0
  double heading = 0.0;                  // for `one_way`: radians
  double half_angle = 0.0;               // for `one_way`: radians, > 0
  std::vector<std::size_t> robots = {};  // the robots that it is for, ascending; empty: all robots
  /// For `blocked`: robots inside may leave, see ways_out.h, and goals inside are put off. If false, no robot
  /// may be inside at any time.
  bool may_leave = false;

  bool is_for(std::size_t robot) const {
    return robots.empty() || std::binary_search(robots.begin(), robots.end(), robot);
  }
  /// Whether no robot may be inside at any time.
  bool is_wall() const { return type == Type::blocked && !may_leave; }

  /// Returns the limit, metres per second, for a robot with this linear speed of its own.
  double linear_speed_for(double own_speed) const {
    return std::min(linear_speed, linear_speed_share * own_speed);
  }
};

}  // namespace fleetplan::core
