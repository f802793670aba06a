#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/fleet/fleet_reservations.h"
#include "core/model/trajectory.h"
#include "core/runtime/random.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Plans these robots all at once, in steps along the rows and columns of one lattice (see plan_steps), among
/// the other ones that stay: the quickest way to plan a thousand robots, where each vertex has room for one.
/// Then gives the steps times, as a temporal plan graph does (Hönig et al., ICAPS 2016): robots come to each
/// vertex in the order of the steps, and one sets out for a vertex as soon as it does not meet the one that
/// was there before it and is on its way to the next one.
///
/// None if there is no such plan, if `stop` is met, or if such steps do not suffice to keep the fleet apart
/// or to describe it: if two robots together are wider than the spacing of the lattice, if lattices differ,
/// if a start or goal is off the lattice or shared, if robots yield, or have several goals, loads or zones of
/// their own to drive by, if any robot has a commitment, among moving obstacles, with a horizon or an
/// interval margin, and for too many robots and vertices. PlaceSteps does without these conditions.
///
/// Returns a trajectory for each of the robots, in their order.
std::optional<std::vector<Trajectory>> plan_on_lattice(const FleetReservations& reservations,
                                                       const std::vector<std::size_t>& robots, Random& random,
                                                       const StopCondition& stop);

}  // namespace fleetplan::core
