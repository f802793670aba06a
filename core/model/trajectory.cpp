#include "core/model/trajectory.h"

namespace fleetplan::core {

std::vector<TimedSegment> timed_segments(const Trajectory& trajectory) {
  std::vector<TimedSegment> segments;
  segments.reserve(2 * trajectory.moves.size() + 1);
  double now = 0.0;
  Position here = trajectory.start;
  for (const TimedSegment& move : trajectory.moves) {
    if (move.t_start > now) segments.push_back({{here, here}, now, move.t_start});
    segments.push_back(move);
    now = move.t_end;
    here = move.path.to;
  }
  segments.push_back({{here, here}, now, kForever});
  return segments;
}

}  // namespace fleetplan::core
