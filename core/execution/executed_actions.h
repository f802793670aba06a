#pragma once

// The planned execution of robots: their actions, what their waits are for, and the planned times of
// progress. Whole progress is the number of actions executed, plus the fraction of the action under way. If
// its speed changes, this is a fraction of its length.

#include <cstddef>
#include <span>
#include <vector>

#include "core/execution/dependencies.h"
#include "core/geometry/segment.h"
#include "core/model/action.h"
#include "core/model/plan.h"
#include "core/model/robot.h"

namespace fleetplan::core {

/// The actions of one robot.
using Actions = std::span<const Action>;

/// Returns, by robot, the actions that it executes: the actions of its plan. Without a plan, the committed
/// actions, or none if the robot is invalid. The spans refer to the arguments.
std::vector<Actions> executed_actions(const std::vector<Robot>& robots, const std::vector<RobotPlan>& plans);

/// The planned time of a progress in these actions, seconds. An action without duration happens when it ends.
double planned_time(Actions actions, std::size_t action, double fraction);

/// What a wait is for. The rest of the wait only gives way to others, or keeps to the clock.
struct WaitPurpose {
  double least = 0.0;       // seconds: a service, or a wait that was added before a translation
  double not_before = 0.0;  // seconds: these do not begin earlier
};

/// Returns, by action, what its wait is for. An action that does not wait has no purpose. `wait_before_move`:
/// PlanOptions::wait_before_move in seconds, or 0 if added waits may be shortened. A service at the end of a
/// longer added wait counts towards it.
std::vector<WaitPurpose> wait_purposes(const Robot& robot, Actions actions, double wait_before_move);

/// A translation, a phase of a translation with a profile, or consecutive actions in one place.
struct PlannedStretch {
  TimedSegment planned;   // the last one has no end: the robot rests
  double begin = 0.0;     // whole progress
  double length = 0.0;    // the number of actions; 0 of a rest after the last action
  double radius = 0.0;    // metres, of the disk that the robot occupies
  bool separates = true;  // whether it keeps others away in ways that the stretches beside it do not
};

/// The planned progress of one robot over time, and the inverse.
class Pace {
 public:
  explicit Pace(Actions actions) : actions_(actions) {}

  /// Returns the whole progress at time `t`; 0 before the first action.
  double progress_at(double t) const;
  /// Returns the time of a whole progress, seconds.
  double time_at(double progress) const;

  /// Returns the progress as a gate, which the robot may not pass. Between two actions, it is the begin of
  /// the later action.
  ActionProgress gate(std::size_t robot, double progress) const;
  /// Returns the progress as a point that the robot must reach. Between two actions, it is the end of the
  /// earlier action.
  ActionProgress until(std::size_t robot, double progress) const;

 private:
  Actions actions_;
};

/// The stretches of a robot that executes these actions, from t = 0 in its start. `margin` (metres) is added
/// to its radius, which changes with the goals that it serves (Goal::radius_after). During an action that
/// ends with such a change, the robot takes the larger space.
std::vector<PlannedStretch> stretches_of(const Robot& robot, Actions actions, double margin);

}  // namespace fleetplan::core
