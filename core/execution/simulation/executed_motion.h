#pragma once

// What a robot did in one execution of its plan.

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include "core/execution/drive.h"
#include "core/execution/simulation/disturbance.h"
#include "core/model/action.h"
#include "core/model/robot.h"
#include "core/runtime/stop_condition.h"
#include "core/verify/execution.h"

namespace fleetplan::core {

/// A robot has executed `action` up to `fraction` at time `t`.
struct ExecutionKnot {
  double t = 0.0;  // seconds
  std::size_t action = 0;
  double fraction = 0.0;
  double ramp = 0.0;  // how the speed changes from the knot before, see TimedSegment
};

/// The progress of a robot. Within an action, acceleration is constant from knot to knot, and usually 0.
/// Every action that has begun has a knot with fraction 0.
struct ExecutedProgress {
  std::vector<ExecutionKnot> knots;
  bool arrived = true;  // false: it stands at the last knot for ever

  double end() const { return knots.empty() ? 0.0 : knots.back().t; }
};

/// Returns where the robot is from t = 0 on, as legs like the legs of `execute`. Several stand-stills in one
/// place are one leg. Returns none if `stop` is met first.
std::optional<std::vector<Leg>> executed_legs(const Robot& robot, const std::vector<Action>& planned,
                                              const DisturbedActions& disturbed,
                                              const ExecutedProgress& progress, const StopCondition& stop);

/// Returns the executed motion as actions, contiguous in time and space: planned actions at their executed
/// times. They are cut where the robot halts, or where the offset from its path changes. Headings are the
/// planned headings. The parts of an action with a profile have a profile, too, unless a clock changed their
/// acceleration. Returns none if there are more than `max_actions`, or if `stop` is met first.
std::optional<std::vector<Action>> disturbed_actions(const std::vector<Action>& planned,
                                                     const DisturbedActions& disturbed,
                                                     const ExecutedProgress& progress,
                                                     std::size_t max_actions, const StopCondition& stop);

/// Returns the progress of robots that follow their profiles over time. `by_time` has fractions of the
/// planned duration of actions, and constant speeds.
ExecutedProgress by_profiles(const std::vector<Action>& planned, ExecutedProgress by_time);

/// Builds the progress of one robot, from t = 0 on.
class ProgressBuilder {
 public:
  double now() const { return now_; }
  double fraction() const { return fraction_; }

  void begin_action(std::size_t action) {
    action_ = action;
    fraction_ = 0.0;
    add_knot();
  }
  void stand_for(double seconds) { go_on(seconds, fraction_); }
  void stand_until(double t) { go_on(std::max(0.0, t - now_), fraction_); }
  /// Moves at constant speed to a fraction of the action.
  void go_on(double seconds, double to_fraction) {
    if (seconds <= 0.0 && to_fraction == fraction_) return;
    now_ += seconds;
    fraction_ = to_fraction;
    add_knot();
  }
  /// Moves as a drive does. The drive may lead through several actions.
  void drive(const std::vector<DrivenPiece>& pieces) {
    // Bounded: the pieces, and each action once.
    for (const DrivenPiece& piece : pieces) {
      while (action_ < piece.action) {
        go_on(0.0, 1.0);
        begin_action(action_ + 1);
      }
      now_ = std::max(now_, piece.t_end);
      fraction_ = piece.to;
      add_knot(piece.ramp);
    }
  }
  /// Completes the actions before `end` that are complete within rounding.
  void complete(std::size_t end) {
    while (action_ + 1 < end) {
      go_on(0.0, 1.0);
      begin_action(action_ + 1);
    }
    go_on(0.0, 1.0);
  }

  const ExecutedProgress& progress() const { return progress_; }
  ExecutedProgress& progress() { return progress_; }

 private:
  void add_knot(double ramp = 0.0) { progress_.knots.push_back({now_, action_, fraction_, ramp}); }

  double now_ = 0.0;
  std::size_t action_ = 0;
  double fraction_ = 0.0;
  ExecutedProgress progress_;
};

}  // namespace fleetplan::core
