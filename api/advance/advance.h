#pragma once

// The fleet at a later moment of its plan. All poses are in the client's world, so that no number changes
// that the moment does not change.

#include <optional>
#include <vector>

#include "core/geometry/moving_obstacle.h"
#include "core/model/action.h"
#include "core/model/robot.h"
#include "core/model/zone.h"
#include "core/runtime/work.h"

namespace fleetplan::api {

/// What holds for all robots. Seconds, metres.
struct Moment {
  double at = 0.0;
  std::optional<double> commit;  // the horizon of commitment; none: the action under way
  double pose_tolerance = 0.1;
  double wait_before_move = 0.0;  // of the request's options
  double inflation = 0.0;         // likewise
  std::vector<core::Zone> zones = {};
};

/// What a robot does, and what happened to it.
struct Execution {
  std::vector<core::Action> actions;  // that it executes, from t = 0 in its start
  bool planned = false;               // they are a plan; otherwise a commitment, at whose end it stays
  std::optional<core::Pose> measured = {};
  std::optional<double> hold = {};  // until then on the clock of the moment
  std::optional<std::vector<core::Goal>> goals = {};
};

/// The robot of the request of that moment: its start, goals, radius, committed and previous actions. Its
/// radius is the one after the goals that it has left behind, and after a last goal that it has served. It
/// has no previous actions if it has no plan, is elsewhere than planned, or gets other goals.
core::Robot advanced(const core::Robot& robot, const Execution& execution, const Moment& moment);

/// All of them. Where a measured robot would break the rule of a zone if it went on, its commitment ends
/// before the action. Committed actions end where they touch another robot that is committed or stands at the
/// end of its commitment: see clear_commitments.
std::vector<core::Robot> advanced(const std::vector<core::Robot>& robots,
                                  const std::vector<Execution>& executions, const Moment& moment,
                                  core::Work& stop);

/// What is left of an obstacle; nothing if it has left.
std::optional<core::MovingObstacle> advanced(const core::MovingObstacle& obstacle, double at);

}  // namespace fleetplan::api
