#pragma once

#include <cstddef>

#include "core/instance.h"
#include "core/model/itinerary.h"
#include "core/sipp/cost_to_go.h"
#include "core/sipp/vertices.h"

namespace fleetplan::core {

/// What a search for one robot needs besides reservations: where and when its plan begins, its goals, and its
/// view of the static map.
struct SearchSpace {
  const Itinerary& itinerary;
  Vertices vertices;
  CostToGo cost_to_go;

  SearchSpace(const Instance& instance, std::size_t robot)
      : itinerary(instance.itinerary(robot)), vertices(instance, robot), cost_to_go(vertices) {}
};

}  // namespace fleetplan::core
