#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/fleet/fleet_reservations.h"
#include "core/model/trajectory.h"
#include "core/moves/configuration_search.h"
#include "core/moves/joint_steps.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// The steps of robots from each configuration to the next.
struct StepSequence {
  std::vector<Configuration> configurations;
  std::vector<double> departures = {};  // seconds, by step: no robot sets out sooner; empty: at any time
  double earliest = 0.0;                // seconds: nobody turns sooner
};

/// Gives the steps of robots times, as a temporal plan graph does (Hönig et al., ICAPS 2016). In the order of
/// the steps, each robot sets out as soon as it meets
///
/// - no robot that moves before it,
/// - no obstacle,
/// - and nothing that is reserved in the table for other robots.
///
/// `robots` make the steps; their own reservations do not count. Returns a trajectory for each of the robots,
/// in their order. None if a robot would have to be elsewhere at some time, or if `stop` is met first.
std::optional<std::vector<Trajectory>> times_of_steps(FleetReservations& reservations,
                                                      const std::vector<std::size_t>& robots,
                                                      const JointSteps& steps, const StepSequence& sequence,
                                                      const StopCondition& stop);

/// When obstacles, committed motion and all robots but these have come to rest, seconds. 0 if nothing else
/// moves.
double rest_of_others(const FleetReservations& reservations, const std::vector<std::size_t>& robots);

}  // namespace fleetplan::core
