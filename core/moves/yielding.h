#pragma once

// Robots that yield (Robot::yields). After their own goals, they may move once more to make way for others.

#include <cstddef>

#include "core/fleet/plan_state.h"

namespace fleetplan::core {

/// Whether robots of the problem yield.
bool any_yields(const Instance& instance);

/// Plans a robot as PlanState::search() does, but past robots that yield. A planned robot that yields counts
/// as gone once it has served its own goals and stood there for the start safe interval. No trajectory if
/// there are no such robots. Afterwards, all reservations are as before.
SearchResult plan_past_yielding(PlanState& state, std::size_t robot, const SearchSettings& settings,
                                const StopCondition& stop);

/// Plans a robot that yields and has a trajectory again, so that it makes way for `other`, which has no
/// reservation. The robot does not end at the goal of `other` that is nearest to its present end. Afterwards,
/// all reservations are as before.
SearchResult plan_making_way(PlanState& state, std::size_t robot, std::size_t other,
                             const SearchSettings& settings, const StopCondition& stop);

/// Whether a robot yields and moves after it has served its own goals.
bool makes_way(const FleetReservations& reservations, std::size_t robot);

}  // namespace fleetplan::core
