#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/geometry/segment.h"
#include "core/geometry/speed_profile.h"

namespace fleetplan::core {

/// A visit of a robot to one of its goals. Seconds.
struct Visit {
  std::size_t goal = 0;   // see Robot::goal_at
  double t_arrive = 0.0;  // begin of the rest in the goal pose
  double t_leave = 0.0;   // the end of the service; kForever at the last goal, where the robot stays
};

/// A straight move of a robot. A move of length 0 leads from a place off the lattice to the vertex there.
struct TimedMove : TimedSegment {
  std::optional<SpeedProfile> profile = {};  // nullopt: at constant speed
  bool reverse = false;                      // backwards
  /// Of a planned move: whether it follows the move before without a stop. It goes straight on, at another
  /// speed or with its own profile.
  bool continues = false;
};

/// The motion of one robot's centre from t = 0 on, committed moves included. The robot waits between moves
/// and stays at the end of the last one. Rotations and services take place during the waits.
struct Trajectory {
  Position start{0.0, 0.0};
  std::vector<TimedMove> moves;  // in order of time, each from the end of the previous one
  double cost = 0.0;  // seconds until it rests in the goal pose, the last rotation and service included
  std::vector<Visit> visits = {};  // to goals of Robot::via, after the committed actions
  /// Seconds: the end of the service at the last goal, if the robot's radius changes then.
  double last_served = kForever;
  /// Seconds: the plan stops here, at or after the horizon, with goals left. `cost` is then an estimate that
  /// includes the static way that is left.
  std::optional<double> stops_at = {};
  /// With `stops_at`: the visits to the goals that are left, if no robot is in the way from there on.
  std::vector<Visit> estimated_visits = {};
  /// With `stops_at`: whether the rest of the way, alone on the static map, takes as long from there as from
  /// the beginning of the plan.
  bool gains_nothing = false;
  double smoothed_by = 0.0;  // seconds by which it costs less than the path that a search has found
  bool is_previous = false;  // the motion of Robot::previous: its actions are the received ones

  Position end() const { return moves.empty() ? start : moves.back().path.to; }
};

/// The trajectory as contiguous timed segments from t = 0 to kForever, waits included. A move with a profile
/// is divided into its phases.
inline std::vector<TimedSegment> timed_segments(const Trajectory& trajectory) {
  std::vector<TimedSegment> segments;
  segments.reserve(2 * trajectory.moves.size() + 1);
  double now = 0.0;
  Position here = trajectory.start;
  // Bounded: the moves of one trajectory, and at most three phases of each.
  for (const TimedMove& move : trajectory.moves) {
    if (move.t_start > now) segments.push_back({{here, here}, now, move.t_start});
    if (move.profile) {
      for (const TimedSegment& phase : phases(move, *move.profile)) segments.push_back(phase);
    } else {
      segments.push_back(move);
    }
    now = move.t_end;
    here = move.path.to;
  }
  segments.push_back({{here, here}, now, kForever});
  return segments;
}

}  // namespace fleetplan::core
