#pragma once

// Where a robot may rest between the steps of a fleet, and its steps from there.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/fleet/fleet_reservations.h"
#include "core/geometry/position.h"
#include "core/geometry/segment.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// The places of one robot, and the steps between them: straight moves that walls, zones and the robots that
/// stay leave free. A place is a vertex in a stage of the way. So a step to the vertex of a stage's goal
/// leads to the next stage. All places can be reached from the start.
struct StepPlaces {
  struct Step {
    int to = -1;
    float length = 0.0F;  // metres
  };
  struct Place {
    Position position{0.0, 0.0};
    double radius = 0.0;      // metres, to other robots
    std::uint32_t stage = 0;  // goals that are served
    std::uint32_t first = 0;  // of the steps
    float to_go = 0.0F;       // metres to the last goal, through the goals before it; kForever: no way
  };

  std::vector<Place> places;  // the start is the first one
  std::vector<Step> steps;    // by place
  int last_goal = -1;         // the place where the robot ends; -1: wherever its goals are served
  std::uint32_t last_stage = 0;

  const Place& at(int place) const { return places[static_cast<std::size_t>(place)]; }
  std::span<const Step> steps_from(int place) const {
    const std::size_t k = static_cast<std::size_t>(place);
    const std::size_t end = k + 1 < places.size() ? places[k + 1].first : steps.size();
    return {steps.data() + places[k].first, end - places[k].first};
  }
  /// Whether a way leads from this place to the end.
  bool has_way(int place) const { return at(place).to_go < static_cast<float>(kForever); }
  /// Whether a robot at this place has served all goals and may stay.
  bool is_end(int place) const { return last_goal >= 0 ? place == last_goal : at(place).stage == last_stage; }
};

/// Returns the places of these robots, in their order, among the robots that stay. None if a robot has no way
/// to its goals, if there are too many places, or if `stop` is met first. `sparse` sets the distance between
/// places: the distance of the widest two robots in contact, times `sparse`. 0: all vertices are places.
std::optional<std::vector<StepPlaces>> places_of_steps(const FleetReservations& reservations,
                                                       const std::vector<std::size_t>& robots, double sparse,
                                                       const StopCondition& stop);

}  // namespace fleetplan::core
