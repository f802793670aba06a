#pragma once

// Random pairs of moving disks, and their smallest distance by bisection.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/geometry/disk_motion.h"
#include "tests/support/random_problem.h"

namespace fleetplan::core {

inline Position direction(double angle) { return {std::cos(angle), std::sin(angle)}; }

/// A straight move of my disk, and a segment of another disk.
struct Encounter {
  Position from;
  Position velocity;
  double duration;
  MovingDisk other;
  double reach;

  MovingDisk departing(double t) const { return {moved(from, velocity, duration, t)}; }

  static MovingDisk moved(const Position& from, const Position& velocity, double duration, double t) {
    MovingDisk disk;
    disk.from = from;
    disk.velocity = velocity;
    disk.t_start = t;
    disk.t_end = t + duration;
    return disk;
  }
};

/// Velocities are oblique, parallel, antiparallel, almost parallel or equal; the other disk may also wait,
/// for a while or without end. All within a few metres.
inline Encounter random_encounter(support::Dice& dice) {
  Encounter e;
  e.from = {dice.between(-3, 3), dice.between(-3, 3)};
  const double angle = dice.between(-4, 4);
  const double speed = dice.between(0.1, 3);
  e.velocity = speed * direction(angle);
  e.duration = dice.between(0.05, 5);
  e.reach = dice.between(0.05, 2);
  const Position from(dice.between(-3, 3), dice.between(-3, 3));
  double length = dice.between(0.05, 5);
  Position velocity = dice.between(0.1, 3) * direction(dice.between(-4, 4));
  switch (dice.below(8)) {
    case 0:
      velocity = dice.between(0.1, 3) * direction(angle);
      break;
    case 1:
      velocity = -dice.between(0.1, 3) * direction(angle);
      break;
    case 2:
      velocity = e.velocity;
      break;
    case 3:
      velocity = dice.between(0.1, 3) * direction(angle + std::pow(10.0, dice.between(-14, -3)));
      break;
    case 4:
      velocity = Position(0.0, 0.0);
      break;
    case 5:
      velocity = Position(0.0, 0.0);
      length = kForever;
      break;
    default:
      break;
  }
  e.other = Encounter::moved(from, velocity, length, dice.between(-5, 20));
  return e;
}

/// The smallest distance of the centres while both segments last; infinite if they do not overlap in time.
/// Its square is convex, so bisection finds where its slope changes sign.
inline double closest(const MovingDisk& a, const MovingDisk& b) {
  double low = std::max(a.t_start, b.t_start);
  double high = std::min(a.t_end, b.t_end);
  if (low > high) return kForever;
  const Position relative = a.velocity - b.velocity;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (Position(a.at(middle) - b.at(middle)).dot(relative) > 0.0 ? high : low) = middle;
  }
  const double t = 0.5 * (low + high);
  return Position(a.at(t) - b.at(t)).norm();
}

}  // namespace fleetplan::core
