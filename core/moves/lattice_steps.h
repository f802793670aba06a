#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/fleet/fleet_reservations.h"
#include "core/model/trajectory.h"
#include "core/runtime/random.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Plans these robots all at once, in steps along the rows and columns of one lattice (see plan_steps). The
/// other robots stay. This is the quickest way to plan a thousand robots if each vertex has room for one
/// robot.
///
/// Then gives the steps times, as a temporal plan graph does (Hönig et al., ICAPS 2016). Robots come to each
/// vertex in the order of the steps. A robot sets out for a vertex as soon as it does not meet the robot that
/// was there before, which is on its way to its next vertex.
///
/// Returns a trajectory for each of the robots, in their order. None if there is no such plan, if `stop` is
/// met, or if such steps cannot keep the fleet apart or describe it. The steps cannot do this in these cases:
///
/// - Two robots together are wider than the spacing of the lattice, or lattices differ.
/// - A start or goal is off the lattice or shared.
/// - Robots yield, or have several goals, several loads, or drive zones of their own.
/// - Any robot has a commitment.
/// - There are moving obstacles, a horizon or an interval margin.
/// - There are too many robots and vertices.
///
/// PlaceSteps has none of these limits.
std::optional<std::vector<Trajectory>> plan_on_lattice(const FleetReservations& reservations,
                                                       const std::vector<std::size_t>& robots, Random& random,
                                                       const StopCondition& stop);

}  // namespace fleetplan::core
