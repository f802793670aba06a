#pragma once

#include <cstddef>
#include <vector>

#include "core/verify/execution/departure.h"
#include "core/verify/execution/execution.h"

namespace fleetplan::core {

/// Robots that execute their plans. All lists are in the same order; a position in them is not the index of
/// the robot.
struct ExecutedFleet {
  std::vector<std::size_t> robots;  // their indices, ascending
  std::vector<double> radii;        // metres, bare
  std::vector<double> tolerances;   // metres
  std::vector<std::vector<Leg>> legs;
  std::vector<Departure> departures;
  std::vector<bool> invalid;  // see Robot::invalid

  std::size_t size() const { return robots.size(); }
};

}  // namespace fleetplan::core
