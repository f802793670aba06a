#pragma once

#include <cstddef>
#include <vector>

#include "core/verify/execution/departure.h"
#include "core/verify/execution/execution.h"

namespace fleetplan::core {

/// Robots that execute their plans. All lists are in the same order; a position in them is not the index of
/// the robot. A robot whose radius changes has several positions, one after the other, for one time each (see
/// bodies_of).
struct ExecutedFleet {
  std::vector<std::size_t> robots;  // their indices, ascending
  std::vector<double> radii;        // metres, bare
  std::vector<double> vicinities;   // metres, added against robots
  std::vector<double> tolerances;   // metres
  std::vector<std::vector<Leg>> legs;
  std::vector<Departure> departures;
  std::vector<bool> invalid;  // see Robot::invalid
  std::vector<bool> stays;    // without a plan or a goal: where the commitment ends, for ever

  std::size_t size() const { return robots.size(); }
  /// Whether these are the same robot.
  bool same_robot(std::size_t one, std::size_t other) const { return robots[one] == robots[other]; }
  double begin_of(std::size_t position) const { return legs[position].front().t_begin; }
  double end_of(std::size_t position) const { return legs[position].back().t_end; }
  /// The distance that two robots keep while neither begins too near nor is committed, metres. `inflation` is
  /// added to each.
  double kept_distance(std::size_t one, std::size_t other, double inflation) const {
    return radii[one] + radii[other] + 2.0 * inflation + (vicinities[one] + vicinities[other]);
  }
};

}  // namespace fleetplan::core
