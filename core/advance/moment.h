#pragma once

// A moment of a plan that is being executed, and what is known of each robot at this moment.

#include <cstddef>
#include <optional>
#include <vector>

#include "core/execution/dependencies.h"
#include "core/model/action.h"
#include "core/model/robot.h"
#include "core/model/surroundings.h"

namespace fleetplan::core {

/// Copying an action several times is as much work as reading so many bytes.
inline constexpr std::size_t kWorkOfAnAction = 256;

/// What holds for all robots. Seconds, metres.
struct Moment {
  double at = 0.0;
  std::optional<double> commit;  // the horizon of commitment; none: the action under way
  double pose_tolerance = 0.1;
  double wait_before_move = 0.0;  // of the request's options
  double inflation = 0.0;         // of the request's options
  bool has_horizon = false;       // of the request's options; then the ages of goals count
  /// Set if robots have reported how far they are released. Then each robot is committed to that, and stands
  /// at least until this time, see standing_time.
  std::optional<double> stand_until = {};
};

/// How far a robot says that it is.
struct ReportedState {
  ActionPlace place;                         // in one of its actions
  std::optional<double> service_left = {};   // seconds, if the action is a service
  std::optional<ActionPlace> released = {};  // it may drive to there; nobody can take that back
};

/// What a robot does, and what happened to it.
struct Execution {
  std::vector<Action> actions;  // that it executes, from t = 0 in its start
  bool planned = false;         // they are a plan; otherwise a commitment, at whose end it stays
  std::optional<std::size_t> first_unserved = {};  // the first goal that the plan leaves, by its visits
  std::optional<Pose> measured = {};
  std::optional<ReportedState> reported = {};  // measured there, if it has a measured pose, too
  std::optional<double> speed = {};            // measured, metres per second, negative backwards
  std::optional<double> hold = {};             // until then on the clock of the moment
  std::optional<std::vector<Goal>> goals = {};
  double stop_distance = 0.0;      // metres that it drives until it can stand, if it drives at the moment
  bool stays_when_served = false;  // then it has no goal any more, and does not move
};

/// A fleet that executes plans, at a moment.
struct FleetInMotion {
  std::vector<Robot> robots;
  std::vector<Execution> executions;  // by robot
  std::vector<MovingObstacle> obstacles;
  Moment moment;
};

}  // namespace fleetplan::core
