#pragma once

// Collisions of two disks that move along straight lines. `reach` is the distance of the centres below which
// they collide: the sum of the radii.
//
// At constant speed, all of this has a closed form. Progress along my move is s in [0, d], along the other's
// segment u in [0, L], both in seconds. The positions collide where |q + va s - vb u| < reach. This is a
// convex region (the inside of an ellipse, or a strip if the velocities are parallel) clipped to a rectangle.
// My departure is t0 + u - s, which is linear. So the departures of my move that collide with one timed
// segment are one interval. Its ends lie on the rectangle's edges or at the ellipse's two extreme points.
//
// Times are exact to about 1e-12 s, except where paths only touch. There, the square root loses half of the
// digits. But the overlap is of second order in that error and stays below 1e-12 m.
//
// At constant acceleration, the lengths s and u at which the two collide form the same convex region. For
// each s and u, one departure lets the two disks be there at the same time, and it is continuous in s and u.
// So the departures that collide are one interval again. It contains the departure that makes the two meet
// where their paths are nearest. From there, its ends are found towards departures without a common time:
//
// 1. Newton's method estimates an end.
// 2. The end is bracketed within kDepartureError, rounded outwards, by bisection where the estimate was
//    wrong.
//
// Whether two disks collide is decided on their relative motion, a parabola. In a time T, it deviates from
// its chord by at most a T^2 / 8. Its squared distance lies above its tangents where it is convex. If neither
// decides, each half of the motion is examined, up to kParabolaError.
//
// The time of the nearest approach, and the times when two disks are too near, are exact. The squared
// distance is of degree four in time, and monotone between the roots of its derivative.

#include <optional>

#include "core/geometry/segment.h"

namespace fleetplan::core {

/// The error of departures of motion at constant acceleration, seconds.
inline constexpr double kDepartureError = 1e-10;
/// The error of the distances in collisions at constant acceleration, metres. Far below kSearchSlack.
inline constexpr double kParabolaError = 1e-11;

/// A disk that moves along a timed segment, with its velocity computed once.
struct MovingDisk {
  Position from{0.0, 0.0};      // at t_start
  Position velocity{0.0, 0.0};  // the mean, metres per second, zero for a wait
  double t_start = 0.0;
  double t_end = 0.0;  // kForever only with zero velocity
  double ramp = 0.0;   // see TimedSegment

  MovingDisk() = default;
  explicit MovingDisk(const TimedSegment& segment)
      : from(segment.path.from),
        velocity(segment.velocity()),
        t_start(segment.t_start),
        t_end(segment.t_end),
        ramp(segment.ramp) {}

  /// Where it is if it keeps its mean speed.
  Position at_mean_speed(double t) const { return from + velocity * (t - t_start); }
  Position at(double t) const {
    if (ramp == 0.0) return at_mean_speed(t);
    const double duration = t_end - t_start;
    return from + velocity * (duration * covered_share((t - t_start) / duration, ramp));
  }
  /// Metres per second squared.
  Position acceleration() const {
    return ramp == 0.0 ? Position(0.0, 0.0) : Position(velocity * (2.0 * ramp / (t_end - t_start)));
  }
  /// How far the disk is at most, in metres, from where it would be at constant speed.
  double sag() const {
    return ramp == 0.0 ? 0.0 : 0.25 * std::abs(ramp) * velocity.norm() * (t_end - t_start);
  }
};

/// Returns whether the two come closer than `reach` while both segments last (paper, "Estimating the
/// feasibility of the move w.r.t. dynamic obstacles").
bool collide(const MovingDisk& a, const MovingDisk& b, double reach);

/// Returns the times at which `b` is closer than `reach` to the point `p`; empty if there are none.
UnsafeInterval unsafe_interval(const Position& p, const MovingDisk& b, double reach);

/// Returns the departure times t at which the move (from, velocity, duration > 0, ramp) comes closer than
/// `reach` to `b`. An end of the interval may be forbidden itself. Then a neighbouring segment of `b` or a
/// safe interval of the move covers it. Use this function on contiguous trajectories only.
UnsafeInterval forbidden_departures(const Position& from, const Position& velocity, double duration,
                                    const MovingDisk& b, double reach, double ramp = 0.0);

/// When two disks are nearer to each other than allowed, seconds; begin <= end.
struct OverlapTime {
  double begin = 0.0;
  double end = 0.0;
};

/// Returns the time during which `a` and `b` are closer than `reach` while both last. None if they are never
/// closer. At constant acceleration, they may be apart in between. Unlike in a search, a common instant
/// counts: a disk that exists only for one instant may overlap another disk.
std::optional<OverlapTime> overlap(const MovingDisk& a, const MovingDisk& b, double reach);

/// When two centres are nearest to each other, and their distance then.
struct Approach {
  double t = 0.0;              // seconds
  double distance = kForever;  // metres
};

/// Returns the nearest approach of two disks that have a common time. One of them changes its speed.
Approach nearest_approach(const MovingDisk& a, const MovingDisk& b);

/// Returns the least distance of the centres while both segments last, metres; kForever if they have no
/// common time.
double least_distance(const MovingDisk& a, const MovingDisk& b);

}  // namespace fleetplan::core
