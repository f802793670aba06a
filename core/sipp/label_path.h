#pragma once

#include "core/model/trajectory.h"
#include "core/sipp/search_space.h"
#include "core/sipp/search_state.h"
#include "core/sipp/stage.h"

namespace fleetplan::core {

/// A stop in the pose of a goal.
struct ServiceStop {
  double t_rest;   // seconds; from then on at rest in the pose
  double t_end;    // of the service
  double heading;  // in which the robot leaves
};

/// The service of a robot that has this label at the goal of its stage.
ServiceStop service_stop(const Label& label, const Stage& stage, const SearchSpace& space);

/// The committed moves of the robot and the path of labels to SearchState::goal_label. Moves of the path that
/// continue straight without a stop are joined.
Trajectory trajectory_of(const SearchState& state, const SearchSpace& space);

}  // namespace fleetplan::core
