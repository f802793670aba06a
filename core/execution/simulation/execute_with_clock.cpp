#include <algorithm>
#include <limits>
#include <utility>

#include "core/execution/simulation/executed_motion.h"
#include "core/execution/simulation/execution_policy.h"

namespace fleetplan::core {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Below this difference, in seconds and as a share of the latest planned time, moments are the same. A robot
/// that is late by all but this is as late as allowed. Planned times that differ by less are equal. It is far
/// above the rounding of sums of durations, and far below what a robot could notice.
constexpr double kLeastSameMoment = 1e-9;
constexpr double kSameShare = 1e-14;
constexpr std::size_t kActionsBetweenPolls = 256;
constexpr std::size_t kClockStepsBetweenPolls = 1024;

/// A part of a robot's plan: from `from` to `to` in planned time.
struct ClockPhase {
  enum class Kind {
    moves,   // takes `seconds` at the robot's own pace, of which the clock may allow less
    stands,  // takes `seconds` by real time, whatever the clock does
    awaits,  // ends when the clock shows the planned time `to`
  };
  Kind kind = Kind::moves;
  std::size_t action = 0;
  double to_fraction = 0.0;
  double from = 0.0;
  double to = 0.0;
  double seconds = 0.0;

  /// The planned seconds that pass in one second.
  double pace() const {
    if (kind != Kind::moves) return 0.0;
    return seconds > to - from ? (to - from) / seconds : 1.0;
  }
};

/// Returns the phases of a robot's whole plan; none if `stop` is met first.
std::optional<std::vector<ClockPhase>> clock_phases(const std::vector<Action>& actions,
                                                    const std::vector<WaitPurpose>& purposes,
                                                    const DisturbedActions& disturbed,
                                                    const StopCondition& stop) {
  using Kind = ClockPhase::Kind;
  std::vector<ClockPhase> phases;
  StopStride stride = StopStride::from_first(stop, kActionsBetweenPolls);
  for (std::size_t k = 0; k < actions.size(); ++k) {
    if (stride.met_at_step()) return std::nullopt;
    const Action& action = actions[k];
    const double begin = action.t_start;
    phases.push_back({.kind = Kind::awaits, .action = k, .from = begin, .to = begin});
    phases.push_back({.kind = Kind::stands,
                      .action = k,
                      .from = begin,
                      .to = begin,
                      .seconds = disturbed.actions[k].start_delay});
    if (action.type == Action::Type::wait) {
      const double least = purposes[k].least;
      phases.push_back({.kind = Kind::awaits, .action = k, .from = begin, .to = action.t_end - least});
      phases.push_back({.kind = Kind::moves,
                        .action = k,
                        .to_fraction = 1.0,
                        .from = action.t_end - least,
                        .to = action.t_end,
                        .seconds = least});
      continue;
    }
    double fraction = 0.0;
    const auto moving = moving_phases(disturbed, k, stop);
    if (!moving) return std::nullopt;
    for (const ActionPhase& phase : *moving) {
      const double planned = action.t_end - begin;
      const Kind kind = phase.to_fraction > fraction ? Kind::moves : Kind::stands;
      phases.push_back({.kind = kind,
                        .action = k,
                        .to_fraction = phase.to_fraction,
                        .from = begin + fraction * planned,
                        .to = phase.to_fraction < 1.0 ? begin + phase.to_fraction * planned : action.t_end,
                        .seconds = phase.seconds});
      fraction = phase.to_fraction;
    }
  }
  return phases;
}

/// Executes plans from event to event. Between two events every robot has a constant pace.
class ClockedExecution {
 public:
  ClockedExecution(const PlannedExecution& planned, const std::vector<DisturbedActions>& disturbed,
                   const StopCondition& stop)
      : planned_(planned),
        disturbed_(disturbed),
        max_delay_(planned.max_delay),
        stop_(stop),
        stride_(stop, kClockStepsBetweenPolls),
        robots_(planned.plans.size()) {}

  std::optional<std::vector<ExecutedProgress>> run() {
    if (!prepare()) return std::nullopt;
    while (true) {
      finish_phases();
      if (stride_.met()) return std::nullopt;
      if (std::all_of(robots_.begin(), robots_.end(), [](const Robot& robot) { return robot.done(); })) break;
      step();
    }
    std::vector<ExecutedProgress> executed;
    executed.reserve(robots_.size());
    for (std::size_t k = 0; k < robots_.size(); ++k) {
      if (stop_.met()) return std::nullopt;
      executed.push_back(by_profiles(planned_.plans[k].actions, std::move(robots_[k].progress)));
    }
    return executed;
  }

 private:
  struct Robot {
    std::vector<ClockPhase> phases = {};
    std::size_t phase = 0;
    double at = 0.0;     // progress in planned time
    double stood = 0.0;  // seconds that a standing phase has lasted
    double pace = 0.0;   // pace since the last knot
    bool begun = false;  // the phase has begun
    ExecutedProgress progress = {};

    bool done() const { return phase == phases.size(); }
    const ClockPhase& now() const { return phases[phase]; }
  };

  /// Prepares the phases of all robots. Returns false if the stop condition is met.
  bool prepare() {
    for (std::size_t k = 0; k < robots_.size(); ++k) {
      const std::vector<Action>& actions = planned_.plans[k].actions;
      auto phases = clock_phases(actions, planned_.purposes[k], disturbed_[k], stop_);
      if (!phases) return false;
      robots_[k].phases = std::move(*phases);
      if (!actions.empty()) {
        same_moment_ = std::max(same_moment_, kLeastSameMoment + kSameShare * actions.back().t_end);
      }
    }
    return true;
  }

  double delay(const Robot& robot) const { return clock_ - robot.at; }

  /// Whether the robot holds the clock back: it is as late as allowed and slower than planned.
  bool holds(const Robot& robot) const {
    return !robot.done() && robot.now().kind != ClockPhase::Kind::awaits && robot.now().pace() < 1.0 &&
           delay(robot) >= max_delay_ - same_moment_;
  }

  bool is_over(const Robot& robot) const {
    const ClockPhase& phase = robot.now();
    switch (phase.kind) {
      case ClockPhase::Kind::moves:
        return robot.at >= phase.to - same_moment_ * std::min(1.0, phase.pace());
      case ClockPhase::Kind::stands:
        return robot.stood >= phase.seconds;
      case ClockPhase::Kind::awaits:
        break;
    }
    return clock_ >= phase.to - same_moment_;
  }

  void finish_phases() {
    for (Robot& robot : robots_) {
      if (stride_.met_at_step()) return;
      while (!robot.done()) {
        if (stride_.met_at_step()) return;
        const ClockPhase& phase = robot.now();
        if (!robot.begun) begin(robot, phase);
        if (!is_over(robot)) break;
        robot.at = phase.to;
        add_knot(robot, {now_, phase.action, phase.to_fraction});
        robot.begun = false;
        robot.stood = 0.0;
        ++robot.phase;
      }
    }
  }

  void begin(Robot& robot, const ClockPhase& phase) {
    robot.begun = true;
    const bool first = robot.progress.knots.empty() || robot.progress.knots.back().action != phase.action;
    if (first) robot.progress.knots.push_back({now_, phase.action, 0.0});
  }

  static void add_knot(Robot& robot, const ExecutionKnot& knot) {
    const ExecutionKnot& last = robot.progress.knots.back();
    if (last.t != knot.t || last.fraction != knot.fraction) robot.progress.knots.push_back(knot);
  }

  /// Returns the pace of a robot while the clock goes at `clock_pace`.
  double pace(const Robot& robot, double clock_pace) const {
    if (robot.done() || robot.now().kind == ClockPhase::Kind::awaits) return 0.0;
    return holds(robot) ? std::min(robot.now().pace(), clock_pace) : robot.now().pace() * clock_pace;
  }

  void step() {
    double clock_pace = 1.0;
    for (const Robot& robot : robots_) {
      if (holds(robot)) clock_pace = std::min(clock_pace, robot.now().pace());
    }
    double seconds = kInfinity;
    for (const Robot& robot : robots_) seconds = std::min(seconds, until_event(robot, clock_pace));
    for (Robot& robot : robots_) {
      if (robot.done()) continue;
      const double pace_now = pace(robot, clock_pace);
      if (pace_now != robot.pace) bend(robot);
      robot.pace = pace_now;
      robot.at += pace_now * seconds;
      robot.stood += seconds;
    }
    clock_ += clock_pace * seconds;
    now_ += seconds;
  }

  /// Returns the seconds until the robot's phase ends or the robot begins to hold the clock back; infinity if
  /// neither happens at these paces.
  double until_event(const Robot& robot, double clock_pace) const {
    if (robot.done()) return kInfinity;
    const ClockPhase& phase = robot.now();
    if (phase.kind == ClockPhase::Kind::awaits) {
      return clock_pace > 0.0 ? (phase.to - clock_) / clock_pace : kInfinity;
    }
    const double robot_pace = pace(robot, clock_pace);
    double seconds = kInfinity;
    if (phase.kind == ClockPhase::Kind::stands) seconds = phase.seconds - robot.stood;
    if (robot_pace > 0.0) seconds = (phase.to - robot.at) / robot_pace;
    if (!holds(robot) && clock_pace > robot_pace) {
      seconds = std::min(seconds, (max_delay_ - delay(robot)) / (clock_pace - robot_pace));
    }
    return std::max(0.0, seconds);
  }

  /// Adds a knot where the pace of a robot changes within a phase.
  void bend(Robot& robot) const {
    const ClockPhase& phase = robot.now();
    if (phase.kind != ClockPhase::Kind::moves || phase.to <= phase.from) return;
    const double begin = robot.phase > 0 && robot.phases[robot.phase - 1].action == phase.action
                             ? robot.phases[robot.phase - 1].to_fraction
                             : 0.0;
    const double part = std::clamp((robot.at - phase.from) / (phase.to - phase.from), 0.0, 1.0);
    add_knot(robot, {now_, phase.action, begin + part * (phase.to_fraction - begin)});
  }

  const PlannedExecution& planned_;
  const std::vector<DisturbedActions>& disturbed_;
  const double max_delay_;
  const StopCondition& stop_;
  StopStride stride_;
  double same_moment_ = kLeastSameMoment;
  double now_ = 0.0;    // seconds
  double clock_ = 0.0;  // planned time
  std::vector<Robot> robots_;
};

}  // namespace

std::optional<std::vector<ExecutedProgress>> execute_with_clock(
    const PlannedExecution& planned, const std::vector<DisturbedActions>& disturbed,
    const StopCondition& stop) {
  return ClockedExecution(planned, disturbed, stop).run();
}

}  // namespace fleetplan::core
