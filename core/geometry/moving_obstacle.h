#pragma once

#include <string>
#include <vector>

#include "core/geometry/position.h"

namespace fleetplan::core {

/// A disk that nobody here controls: a person, a robot of another fleet. It is absent before the first entry,
/// moves straight at constant speed from entry to entry, and then stays or vanishes. The instant at which it
/// appears or vanishes counts as occupied. It may cross walls, the edge of the map and other obstacles.
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

}  // namespace fleetplan::core
