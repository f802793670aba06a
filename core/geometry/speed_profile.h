#pragma once

// How speed changes along a straight line, or during a rotation, when acceleration is limited. It rises at
// constant acceleration to a cruise speed, stays constant, and falls at constant deceleration. On a short
// way, the constant speed takes no time. Formulas: docs/acceleration.md.

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/geometry/segment.h"

namespace fleetplan::core {

/// The time that changes of speed take, per metre (or radian) per second of speed; 0 without a limit.
struct Inertia {
  double rise = 0.0;  // seconds squared per metre: 1 / acceleration
  double fall = 0.0;  // 1 / deceleration

  /// Whether there is a limit. Stored, because every move of a search asks.
  bool is_limited = rise + fall > 0.0;

  bool operator==(const Inertia&) const = default;

  /// Seconds from rest to rest over a distance (metres or radians, >= 0) at this greatest speed.
  double time(double distance, double speed) const {
    if (!is_limited) [[likely]]
      return distance / speed;
    const double mean = 0.5 * (rise + fall);
    return distance >= speed * speed * mean ? distance / speed + speed * mean
                                            : 2.0 * std::sqrt(distance * mean);
  }
  /// The part of that time that starting and stopping take. It never falls with the distance.
  double loss(double distance, double speed) const {
    return is_limited ? time(distance, speed) - distance / speed : 0.0;
  }
};

/// The speed of one action, metres (or radians) per second. cruise >= start, end.
struct SpeedProfile {
  double start = 0.0;
  double cruise = 0.0;
  double end = 0.0;
  Inertia inertia;  // of the robot

  bool is_possible() const { return cruise > 0.0 && cruise >= std::max(start, end); }
  /// Seconds from start to cruise, and from cruise to end.
  double rise_time() const { return (cruise - start) * inertia.rise; }
  double fall_time() const { return (cruise - end) * inertia.fall; }
  /// The lengths covered in these times, metres (or radians).
  double rise_length() const { return 0.5 * (start + cruise) * rise_time(); }
  double fall_length() const { return 0.5 * (cruise + end) * fall_time(); }
};

/// A part of a straight way, with a greatest speed.
struct LimitedPart {
  double length = 0.0;          // metres, > 0
  double limit = 0.0;           // metres per second
  double end_limit = kForever;  // metres per second, at its end
};

/// Returns, for each part, the fastest profile of a translation through all of them, to rest. If the robot
/// could not come to rest from the start speed, the start speed is lowered to the greatest possible.
std::vector<SpeedProfile> fastest_profiles(const std::vector<LimitedPart>& parts, const Inertia& inertia,
                                           double start_speed = 0.0);

/// Returns the fastest profile from rest to rest, also for rotations.
SpeedProfile fastest_profile(double distance, double speed, const Inertia& inertia);

/// Returns the seconds that a distance takes with this profile.
double duration(const SpeedProfile& profile, double distance);

/// Returns the speed, and the distance covered, `t` seconds after the begin of an action with this profile
/// and this duration. Also returns the time at which it has covered a distance.
double speed_after(const SpeedProfile& profile, double duration, double t);
double covered_after(const SpeedProfile& profile, double duration, double t);
double elapsed_at(const SpeedProfile& profile, double duration, double distance);

/// Returns the greatest speed between two distances from where the profile begins. The whole way is `length`,
/// metres (or radians).
double fastest_between(const SpeedProfile& profile, double first, double last, double length);

/// Returns the parts of a move with this profile in which its acceleration is constant. There are at most
/// three, each from the end of the part before. No part is shorter than kSameTime.
std::vector<TimedSegment> phases(const TimedSegment& move, const SpeedProfile& profile);

}  // namespace fleetplan::core
