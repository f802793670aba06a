#pragma once

#include <algorithm>

#include "core/runtime/arrays.h"
#include "core/runtime/stop_condition.h"
#include "core/sipp/search_space.h"

namespace fleetplan::core {

/// A part of the way of a robot: from the goal before, or from where its plan begins, to the next goal. A
/// robot that has another radius after its last service has one more stage, in which it rests.
struct Stage {
  Vertices::GoalPose goal;
  double service = 0.0;     // seconds
  double not_before = 0.0;  // seconds
  /// Estimate: seconds from rest in the goal's pose to the end of the last service, without waiting for any
  /// `not_before`. The service at this goal is included.
  double after = 0.0;
  /// Estimate: no path ends earlier, because of this `not_before` and the later ones.
  double release = 0.0;

  const Vertices* vertices = nullptr;
  int first_vertex = 0;  // see SearchSpace
  /// Of a robot whose radius changes: by how much its disk is smaller than at most, metres; whether it
  /// changes at the end of this stage; and whether this is the rest after the last service.
  double narrower = 0.0;
  bool radius_changes = false;
  bool is_rest = false;

  double service_end(double t_rest) const { return std::max(t_rest, not_before) + service; }
};

/// The stages of a robot with a goal, without the releases; none if `stop` is met first.
IndexedVector<Stage> stages_of(SearchSpace& space, const StopCondition& stop);
/// Estimates when a robot ends its last service if it is alone on the static map; seconds. 0 if `stop` is met
/// first.
double estimated_end(SearchSpace& space, const StopCondition& stop);
/// `last_free_from`: when the last goal becomes free for good.
void set_releases(IndexedVector<Stage>& stages, double last_free_from);

}  // namespace fleetplan::core
