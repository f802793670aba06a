#pragma once

#include <vector>

#include "core/geometry/segment.h"

namespace fleetplan::core {

/// What one robot's centre does, from t = 0 on: it waits wherever no move is under way, and rests at the end
/// for ever. Rotations take place while it waits.
struct Trajectory {
  Position start{0.0, 0.0};
  std::vector<TimedSegment> moves;  // by time, each beginning where the one before ended; none of length 0
  double cost = 0.0;                // seconds: at rest in the goal pose for good, the last rotation included

  Position end() const { return moves.empty() ? start : moves.back().path.to; }
};

/// The trajectory as contiguous timed segments from t = 0 to for ever, waits included.
std::vector<TimedSegment> timed_segments(const Trajectory& trajectory);

}  // namespace fleetplan::core
