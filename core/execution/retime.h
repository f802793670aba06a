#pragma once

// When robots that execute a plan with dependencies will arrive, and which robots cause the delays of others.

#include <cstddef>
#include <optional>
#include <vector>

#include "core/execution/dependencies.h"
#include "core/execution/executed_actions.h"
#include "core/model/robot.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Where a robot is, and how it goes on.
struct ObservedState {
  std::size_t robot = 0;
  std::size_t action = 0;     // the action under way
  double fraction = 0.0;      // the executed part of the action
  double speed_factor = 1.0;  // > 0: share of its planned speeds that it makes from now on
  double held = 0.0;          // seconds, >= 0, for which it does not move
};

struct RetimeRules {
  double now = 0.0;               // seconds from the start of the plan
  double wait_before_move = 0.0;  // seconds that a robot stands before a translation, if it is planned to
};

/// The new times of a robot's actions.
struct RetimedRobot {
  std::size_t first = 0;     // the action under way; the number of all if it has arrived
  std::vector<double> ends;  // seconds: the ends of the actions from `first` on
  double begin = 0.0;        // seconds: now, the begin of what is left of the action under way
  double delay = 0.0;        // seconds: by how much it arrives later than planned, or earlier if negative
  /// For a robot that arrives late: the robot it waited for last, and the robot whose delay is the root
  /// cause. A robot that is late by itself is its own root cause.
  std::optional<std::size_t> waits_for = {};
  std::optional<std::size_t> because_of = {};
};

/// Returns, by robot, the new times of its actions, if every robot goes on:
///
/// - Moves take their planned time divided by the speed factor. With a profile, the cruise speed is
///   multiplied by the factor.
/// - Services last as long as planned, and begin no earlier than they may.
/// - Other waits end when planned, or at once if this time has passed.
/// - A robot with profiles brakes for a gate. It goes on from the speed that it has when the gate opens.
///
/// Without delays, these are the planned times, unless a gate opens so late that a robot has begun to brake.
/// Robots without a state are as planned.
///
/// `dependencies`: each `until` is planned before its `gate`. `actions`: contiguous in time, ascending.
/// Returns none if the stop condition is met.
std::optional<std::vector<RetimedRobot>> retime(const std::vector<Robot>& robots,
                                                const std::vector<Actions>& actions,
                                                const std::vector<Dependency>& dependencies,
                                                const std::vector<ObservedState>& states,
                                                const RetimeRules& rules, const StopCondition& stop);

}  // namespace fleetplan::core
