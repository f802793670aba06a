#pragma once

// The planned motion of a robot by whole progress: the number of actions executed, and the fraction of the
// one under way.

#include <cstddef>
#include <vector>

#include "core/execution/dependency.h"
#include "core/execution/executed_actions.h"
#include "core/geometry/segment.h"
#include "core/model/robot.h"

namespace fleetplan::core {

/// A translation, or consecutive actions in one place.
struct PlannedStretch {
  TimedSegment planned;   // the last one has no end: the robot rests
  double begin = 0.0;     // whole progress
  double length = 0.0;    // the number of actions; 0 of a rest after the last action
  double radius = 0.0;    // metres, of the space that the robot takes
  bool separates = true;  // whether it keeps others away in ways that those beside it do not
};

/// When a robot is planned to make which whole progress.
class Pace {
 public:
  explicit Pace(Actions actions) : actions_(actions) {}

  /// The progress at this time: 0 before the first action.
  double progress_at(double t) const;
  /// The time of this progress, seconds.
  double time_at(double progress) const;

  /// As a gate, which is not passed: at the begin of an action rather than at the end of the one before.
  ActionProgress gate(std::size_t robot, double progress) const;
  /// As what must be reached: at the end of an action.
  ActionProgress until(std::size_t robot, double progress) const;

 private:
  Actions actions_;
};

/// The stretches of a robot that executes these actions, from t = 0 in its start. `margin` (metres) is added
/// to its radius, which changes with the goals that it serves (Goal::radius_after). During the action that
/// ends with such a change it takes the larger space.
std::vector<PlannedStretch> stretches_of(const Robot& robot, Actions actions, double margin);

}  // namespace fleetplan::core
