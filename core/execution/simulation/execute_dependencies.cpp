#include <algorithm>
#include <functional>
#include <limits>
#include <queue>
#include <tuple>
#include <utility>

#include "core/execution/simulation/disturbance.h"
#include "core/execution/simulation/executed_motion.h"
#include "core/execution/simulation/execution_policy.h"

namespace fleetplan::core {
namespace {

constexpr std::size_t kStepsBetweenPolls = 256;

/// Returns the place of a progress that is to be reached: after an action rather than before the next one.
ActionPlace as_reached(const ActionProgress& progress) {
  if (progress.fraction > 0.0 || progress.action == 0) return {progress.action, progress.fraction};
  return {progress.action - 1, 1.0};
}

/// Returns when the robot reaches the place, seconds; none if it has not come so far.
std::optional<double> time_reached(const ExecutedProgress& progress, const ActionPlace& place) {
  if (place.action == 0 && place.fraction <= 0.0) return 0.0;
  const auto found = std::lower_bound(progress.knots.begin(), progress.knots.end(), place,
                                      [](const ExecutionKnot& knot, const ActionPlace& sought) {
                                        return ActionPlace{knot.action, knot.fraction} < sought;
                                      });
  if (found == progress.knots.end()) return std::nullopt;
  if (found->action != place.action || found == progress.knots.begin()) return found->t;
  const ExecutionKnot& before = *(found - 1);
  if (before.action != place.action) return found->t;
  const double part = (place.fraction - before.fraction) / (found->fraction - before.fraction);
  return before.t + elapsed_share(part, found->ramp) * (found->t - before.t);
}

/// Lets every robot go on as far as it is known to be allowed, until no robot can. Robots whose speed changes
/// at once run ahead of the others, because they stop at a gate only when they are there, whatever becomes
/// known later. Robots that have to brake for a gate drive in the order of time, because what is ahead of
/// them depends on gates that open meanwhile.
class DependentExecution {
 public:
  DependentExecution(const PlannedExecution& planned, const std::vector<DisturbedActions>& disturbed,
                     const StopCondition& stop)
      : planned_(planned),
        disturbed_(disturbed),
        stop_(stop),
        stride_(stop, kStepsBetweenPolls),
        robots_(planned.plans.size()),
        opens_(planned.dependencies.size()),
        waiting_(planned.dependencies.size(), kNobody) {}

  std::optional<std::vector<ExecutedProgress>> run() {
    if (!add_marks()) return std::nullopt;
    ready_.resize(robots_.size());
    for (std::size_t k = 0; k < ready_.size(); ++k) ready_[k] = k;
    while (!ready_.empty() || !events_.empty()) {
      if (stop_.met()) return std::nullopt;
      if (!ready_.empty()) {
        const std::size_t robot = ready_.back();
        ready_.pop_back();
        advance(robot);
        tell(robot);
      } else {
        const Event event = events_.top();
        events_.pop();
        if (event.number == robots_[event.robot].events) drive_on(event.robot, event.t);
      }
      if (stopped_) return std::nullopt;
    }
    std::vector<ExecutedProgress> executed;
    executed.reserve(robots_.size());
    for (std::size_t robot = 0; robot < robots_.size(); ++robot) {
      ExecutedProgress& progress = robots_[robot].builder.progress();
      progress.arrived = robots_[robot].action == planned_.plans[robot].actions.size();
      executed.push_back(std::move(progress));
    }
    return executed;
  }

 private:
  static constexpr std::size_t kNobody = std::numeric_limits<std::size_t>::max();

  /// A gate of a robot, or a place that another robot waits for it to reach.
  struct Mark {
    ActionPlace place;
    std::size_t dependency = 0;
  };
  struct Robot {
    std::vector<Mark> gates = {};
    std::vector<Mark> awaited = {};
    std::size_t gate = 0;  // index of the next one
    std::size_t next_awaited = 0;
    std::size_t action = 0;  // index of the present or next one
    bool begun = false;      // the action has begun
    std::vector<ActionPhase> phases = {};
    std::size_t phase = 0;
    ProgressBuilder builder = {};
    std::optional<DisturbedDrive> driven = {};
    double next_place = 0.0;  // that the drive comes to next
    double next_t = 0.0;      // and when
    std::size_t events = 0;   // number of the drive's events: earlier ones are obsolete
  };
  /// Something changes for a drive.
  struct Event {
    double t = 0.0;
    std::size_t robot = 0;
    std::size_t number = 0;

    bool operator>(const Event& other) const {
      return std::tie(t, robot, number) > std::tie(other.t, other.robot, other.number);
    }
  };

  /// Returns false if the stop condition is met.
  bool add_marks() {
    for (std::size_t k = 0; k < planned_.dependencies.size(); ++k) {
      if (stops_after(1)) return false;
      const Dependency& dependency = planned_.dependencies[k];
      robots_[dependency.gate.robot].gates.push_back({place_of(dependency.gate), k});
      robots_[dependency.until.robot].awaited.push_back({as_reached(dependency.until), k});
    }
    const auto is_earlier = [](const Mark& a, const Mark& b) { return a.place < b.place; };
    for (Robot& robot : robots_) {
      for (std::vector<Mark>* marks : {&robot.gates, &robot.awaited}) {
        if (stops_after(marks->size())) return false;
        // Usually they are sorted already, and so are any number of equal marks.
        if (std::is_sorted(marks->begin(), marks->end(), is_earlier)) continue;
        std::stable_sort(marks->begin(), marks->end(), is_earlier);
      }
    }
    return true;
  }

  /// Counts steps and looks at the stop condition once in many of them. Returns whether it was met.
  bool stops_after(std::size_t steps) { return stopped_ = stopped_ || stride_.met_after(steps); }

  /// Executes a robot until the first of these:
  ///
  /// - the end of its plan,
  /// - a gate that is not known to open,
  /// - the begin of a drive,
  /// - the stop condition is met.
  void advance(std::size_t index) {
    Robot& robot = robots_[index];
    const std::vector<Action>& actions = planned_.plans[index].actions;
    while (robot.action < actions.size()) {
      if (stops_after(1)) return;
      if (!robot.begun) {
        robot.builder.begin_action(robot.action);
        robot.begun = true;
      }
      if (robot.phases.empty()) {
        const double came = robot.builder.now();
        if (!pass_gates(index, 0.0)) return;
        if (actions[robot.action].profile) {
          begin_drive(index, robot.builder.now() > came);
          return;
        }
        if (!prepare(index, robot)) return;
      }
      for (; robot.phase < robot.phases.size(); ++robot.phase) {
        if (stops_after(1) || !advance_phase(index)) return;
      }
      robot.phases.clear();
      robot.begun = false;
      ++robot.action;
    }
  }

  /// Prepares the phases of an action that may begin. Returns false if the stop condition is met.
  bool prepare(std::size_t index, Robot& robot) {
    const DisturbedActions& disturbed = disturbed_[index];
    robot.builder.stand_for(disturbed.actions[robot.action].start_delay);
    robot.phase = 0;
    if (planned_.plans[index].actions[robot.action].type != Action::Type::wait) {
      auto phases = moving_phases(disturbed, robot.action, stop_);
      stopped_ = stopped_ || !phases;
      if (phases) robot.phases = std::move(*phases);
      return !stopped_;
    }
    const WaitPurpose& purpose = planned_.purposes[index][robot.action];
    robot.builder.stand_until(purpose.not_before);
    robot.phases = {{purpose.least, 1.0}};
    return true;
  }

  /// Executes the present phase. Returns false at a gate that is not known to open; what remains of the phase
  /// is kept.
  bool advance_phase(std::size_t index) {
    Robot& robot = robots_[index];
    ActionPhase& phase = robot.phases[robot.phase];
    while (robot.gate < robot.gates.size()) {
      if (stops_after(1)) return false;
      const ActionPlace& place = robot.gates[robot.gate].place;
      if (place.action != robot.action || place.fraction >= phase.to_fraction) break;
      const double from = robot.builder.fraction();
      if (place.fraction > from) {
        const double part = (place.fraction - from) / (phase.to_fraction - from);
        robot.builder.go_on(part * phase.seconds, place.fraction);
        phase.seconds *= 1.0 - part;
      }
      if (!pass_gates(index, place.fraction)) return false;
    }
    robot.builder.go_on(phase.seconds, phase.to_fraction);
    return true;
  }

  /// Waits at the gates up to a fraction of the present action. Returns false if one of them is not known to
  /// open.
  bool pass_gates(std::size_t index, double fraction) {
    Robot& robot = robots_[index];
    const ActionPlace here{robot.action, fraction};
    for (; robot.gate < robot.gates.size() && !(here < robot.gates[robot.gate].place); ++robot.gate) {
      if (stops_after(1)) return false;
      const std::size_t dependency = robot.gates[robot.gate].dependency;
      if (!opens_[dependency]) {
        waiting_[dependency] = index;
        return false;
      }
      robot.builder.stand_until(*opens_[dependency]);
    }
    return true;
  }

  void begin_drive(std::size_t index, bool has_stood) {
    Robot& robot = robots_[index];
    const std::vector<Action>& actions = planned_.plans[index].actions;
    const DisturbedActions& disturbed = disturbed_[index];
    double speed = actions[robot.action].profile->start;
    if (has_stood || !goes_on_at_speed(actions, robot.action)) {
      robot.builder.stand_for(disturbed.actions[robot.action].start_delay);
      speed = 0.0;
    }
    robot.driven.emplace(actions, robot.action, disturbed, robot.builder.now(), speed);
    stops_after(robot.driven->drive.end() - robot.action);
    schedule(index, robot.builder.now());
  }

  void schedule(std::size_t index, double t) { events_.push({t, index, robots_[index].events}); }

  /// Lets a robot drive until `t`, at which something changes, and go on from there.
  void drive_on(std::size_t index, double t) {
    Robot& robot = robots_[index];
    Drive& drive = robot.driven->drive;
    ++robot.events;
    if (drive.stands()) {
      if (t > drive.now()) {
        robot.builder.stand_until(t);
        drive.stand_until(t);
      }
    } else {
      robot.builder.drive(t >= robot.next_t ? drive.drive_to(robot.next_place) : drive.drive_until(t));
    }
    tell_drive(index, t);
    const auto halt = robot.driven->next_halt();
    if (halt && halt->place <= drive.at()) {
      robot.builder.stand_for(halt->seconds);
      robot.driven->pass_halt(robot.builder.now());
      schedule(index, robot.builder.now());
    } else if (!stopped_) {
      head_on(index, t);
    }
  }

  /// Heads a driving robot for the next place at which it has to stop, as far as is known at `t`.
  void head_on(std::size_t index, double t) {
    Robot& robot = robots_[index];
    Drive& drive = robot.driven->drive;
    double stop = drive.length();
    bool waits = false;
    for (; robot.gate < robot.gates.size(); ++robot.gate) {
      if (stops_after(1)) return;
      const Mark& gate = robot.gates[robot.gate];
      if (gate.place.action >= drive.end()) break;
      const std::optional<double>& opens = opens_[gate.dependency];
      if (opens && *opens <= t) continue;
      stop = drive.place_of(gate.place.action, gate.place.fraction);
      waits = stop <= drive.at();
      if (opens) {
        schedule(index, *opens);
      } else {
        waiting_[gate.dependency] = index;
      }
      break;
    }
    if (waits) return;
    if (drive.at() >= drive.length()) {
      end_drive(index);
      return;
    }
    if (const auto halt = robot.driven->next_halt()) stop = std::min(stop, halt->place);
    if (stop != drive.heading_for()) {
      if (stops_after(drive.end() - robot.action)) return;
      drive.head_for(stop);
    }
    robot.next_place = stop;
    if (robot.next_awaited < robot.awaited.size()) {
      const ActionPlace& awaited = robot.awaited[robot.next_awaited].place;
      robot.next_place = std::min(stop, drive.place_of(awaited.action, awaited.fraction));
    }
    robot.next_t = drive.time_at(robot.next_place);
    schedule(index, robot.next_t);
  }

  void end_drive(std::size_t index) {
    Robot& robot = robots_[index];
    const std::size_t end = robot.driven->drive.end();
    robot.builder.complete(end);
    robot.driven.reset();
    robot.action = end;
    robot.begun = false;
    ready_.push_back(index);
  }

  /// Tells others which of the places that they wait for a robot has reached.
  void tell(std::size_t index) {
    Robot& robot = robots_[index];
    for (; robot.next_awaited < robot.awaited.size(); ++robot.next_awaited) {
      if (stops_after(1)) return;
      const Mark& awaited = robot.awaited[robot.next_awaited];
      const auto t = time_reached(robot.builder.progress(), awaited.place);
      if (!t) return;
      open(awaited.dependency, *t);
    }
  }

  /// Tells others which of the places that they wait for a robot has reached that has driven until `t`.
  void tell_drive(std::size_t index, double t) {
    Robot& robot = robots_[index];
    const Drive& drive = robot.driven->drive;
    for (; robot.next_awaited < robot.awaited.size(); ++robot.next_awaited) {
      if (stops_after(1)) return;
      const Mark& awaited = robot.awaited[robot.next_awaited];
      const bool is_ahead = awaited.place.action >= drive.end() ||
                            drive.place_of(awaited.place.action, awaited.place.fraction) > drive.at();
      if (is_ahead) return;
      open(awaited.dependency, t);
    }
  }

  /// From `t` on, the gate of a dependency is open.
  void open(std::size_t dependency, double t) {
    opens_[dependency] = t;
    const std::size_t other = std::exchange(waiting_[dependency], kNobody);
    if (other == kNobody) return;
    if (robots_[other].driven) {
      schedule(other, t);
    } else {
      ready_.push_back(other);
    }
  }

  const PlannedExecution& planned_;
  const std::vector<DisturbedActions>& disturbed_;
  const StopCondition& stop_;
  StopStride stride_;
  bool stopped_ = false;
  std::vector<Robot> robots_;
  std::vector<std::optional<double>> opens_;  // by dependency: when its `until` is reached, if known
  std::vector<std::size_t> waiting_;          // by dependency: the robot at its gate, or heading for it
  std::vector<std::size_t> ready_;            // robots that may go on, but do not drive
  std::priority_queue<Event, std::vector<Event>, std::greater<>> events_;
};

}  // namespace

std::optional<std::vector<ExecutedProgress>> execute_dependencies(
    const PlannedExecution& planned, const std::vector<DisturbedActions>& disturbed,
    const StopCondition& stop) {
  return DependentExecution(planned, disturbed, stop).run();
}

}  // namespace fleetplan::core
