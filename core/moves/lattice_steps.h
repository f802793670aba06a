#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/fleet/fleet_reservations.h"
#include "core/fleet/progress_report.h"
#include "core/model/trajectory.h"
#include "core/runtime/random.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Plans these robots all at once, in steps along the rows and columns of the lattice (see plan_steps), among
/// the other ones that stay. Then gives the steps times, as a temporal plan graph does (Hönig et al., ICAPS
/// 2016): robots come to each vertex in the order of the steps, and one sets out for a vertex as soon as it
/// does not meet the one that was there before it and is on its way to the next one.
///
/// None if there is no such plan, if `stop` is met, or if steps do not suffice to keep the fleet apart or to
/// describe it: if two robots together are wider than the spacing of the lattice, if lattices differ, if a
/// start or goal is off the lattice or shared, if robots yield, or have several goals, loads or zones of
/// their own to drive by, if any robot has a commitment, among moving obstacles, with a horizon or an
/// interval margin, and for too many robots and vertices.
///
/// Returns a trajectory for each of the robots, in their order.
std::optional<std::vector<Trajectory>> plan_in_steps(const FleetReservations& reservations,
                                                     const std::vector<std::size_t>& robots, Random& random,
                                                     const StopCondition& stop);

/// Whether robots follow a plan in steps; if not, whether because the time was over, so that there may be
/// one.
enum class StepsOutcome : std::uint8_t { followed, none, cut_off };

/// Plans the robots of `order`, which no others but those that stay share the map with, in steps, except for
/// the `hopeless` ones, which stay. If all of them have a plan in which nobody meets, they follow it; if not,
/// no reservation has changed. Takes a part of the time until `stop`.
StepsOutcome follow_steps(FleetReservations& reservations, const std::vector<std::size_t>& order,
                          const std::vector<std::size_t>& hopeless, Random& random, const StopCondition& stop,
                          ProgressReport& progress);

}  // namespace fleetplan::core
