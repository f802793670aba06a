#pragma once

namespace fleetplan {

/// A point in the plane, metres.
struct Position {
  double x = 0.0;
  double y = 0.0;

  bool operator==(const Position&) const = default;
};

/// A position with a heading.
struct Pose {
  double x = 0.0;      // metres
  double y = 0.0;      // metres
  double theta = 0.0;  // radians, counter-clockwise from +x; any finite angle. Plans have it in (-pi, pi].

  bool operator==(const Pose&) const = default;
};

}  // namespace fleetplan
