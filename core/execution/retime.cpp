#include "core/execution/retime.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <tuple>
#include <utility>

#include "core/execution/drive.h"

namespace fleetplan::core {

namespace {

/// Seconds: rounding of times that were added up.
constexpr double kOnTime = 1e-6;
constexpr std::size_t kNobody = std::numeric_limits<std::size_t>::max();
constexpr std::size_t kMarksBetweenPolls = 256;

/// A gate of a robot, or a progress that others wait for.
struct Mark {
  double progress = 0.0;
  std::size_t dependency = 0;
};

bool earlier(const Mark& a, const Mark& b) {
  return std::tie(a.progress, a.dependency) < std::tie(b.progress, b.dependency);
}

/// A robot on its way. Progress is whole: the number of actions, and the fraction of the one under way.
struct Traveller {
  Actions actions;
  std::vector<WaitPurpose> purposes;  // by action
  std::vector<Mark> gates;            // ascending
  std::vector<Mark> awaited;          // ascending
  std::size_t next_gate = 0;
  std::size_t next_closed = 0;  // for a drive: the first gate that is not known to be open
  std::size_t next_awaited = 0;
  double at = 0.0;
  double heading_for = 0.0;
  double now = 0.0;
  double speed_factor = 1.0;
  double held_until = 0.0;
  std::size_t because_of = kNobody;
  std::size_t waits_for = kNobody;
  std::optional<Drive> drive = {};  // if the action under way has a profile
  std::size_t arrivals = 0;         // the number of its present arrival; others are obsolete

  double end() const { return static_cast<double>(actions.size()); }
  const Action& action() const { return actions[static_cast<std::size_t>(at)]; }
  /// The place of a progress in the drive.
  double place(double progress) const {
    return drive->place_of(static_cast<std::size_t>(progress), progress - std::floor(progress));
  }
};

double whole(const ActionProgress& progress) {
  return static_cast<double>(progress.action) + progress.fraction;
}

class Forward {
 public:
  Forward(const std::vector<Robot>& robots, const std::vector<Actions>& actions,
          const std::vector<Dependency>& dependencies, const std::vector<ObservedState>& states,
          const RetimeRules& rules)
      : dependencies_(dependencies), rules_(rules), travellers_(robots.size()) {
    for (std::size_t k = 0; k < robots.size(); ++k) {
      Traveller& one = travellers_[k];
      one.actions = actions[k];
      one.purposes = wait_purposes(robots[k], actions[k], rules.wait_before_move);
      one.now = rules.now;
      one.at = Pace(actions[k]).progress_at(rules.now);
    }
    for (const ObservedState& state : states) observe(state);
    met_.resize(dependencies.size());
    waiting_.resize(dependencies.size(), kNobody);
  }

  std::optional<std::vector<RetimedRobot>> run(const StopCondition& stop) {
    if (!begin(stop)) return std::nullopt;
    while (!arrivals_.empty()) {
      if (stop.met()) return std::nullopt;
      const auto [t, robot, number] = arrivals_.top();
      arrivals_.pop();
      if (number == travellers_[robot].arrivals) arrive(robot, t);
    }
    for (std::size_t k = 0; k < travellers_.size(); ++k) finish(k);
    return std::move(retimed_);
  }

 private:
  using Arrival = std::tuple<double, std::size_t, std::size_t>;  // time, robot, its number

  void observe(const ObservedState& state) {
    Traveller& one = travellers_[state.robot];
    one.at = static_cast<double>(state.action) + state.fraction;
    one.speed_factor = state.speed_factor;
    one.held_until = rules_.now + state.held;
    const double planned = Pace(one.actions).time_at(one.at);
    if (planned < rules_.now - kOnTime) one.because_of = state.robot;
  }

  /// Returns false if the stop condition is met.
  bool add_marks(const StopCondition& stop) {
    StopStride stride(stop, kMarksBetweenPolls);
    for (std::size_t k = 0; k < dependencies_.size(); ++k) {
      if (stride.met_at_step()) return false;
      travellers_[dependencies_[k].gate.robot].gates.push_back({whole(dependencies_[k].gate), k});
      travellers_[dependencies_[k].until.robot].awaited.push_back({whole(dependencies_[k].until), k});
    }
    for (Traveller& one : travellers_) {
      for (std::vector<Mark>* marks : {&one.gates, &one.awaited}) {
        if (stop.met()) return false;
        if (!std::is_sorted(marks->begin(), marks->end(), earlier))
          std::sort(marks->begin(), marks->end(), earlier);
      }
    }
    return true;
  }

  /// Prepares the robots, and begins the first move of each. Returns false if the stop condition is met.
  bool begin(const StopCondition& stop) {
    if (!add_marks(stop)) return false;
    for (Traveller& one : travellers_) {
      if (stop.met()) return false;
      const auto first = std::min(static_cast<std::size_t>(one.at), one.actions.size());
      retimed_.push_back({first, std::vector<double>(one.actions.size() - first, rules_.now), rules_.now});
      // A gate that it has passed already does not call it back.
      while (one.next_gate < one.gates.size() && one.gates[one.next_gate].progress < one.at) ++one.next_gate;
      one.next_closed = one.next_gate;
    }
    for (std::size_t k = 0; k < travellers_.size(); ++k) tell(k, rules_.now);
    for (std::size_t k = 0; k < travellers_.size(); ++k) go_on(k, rules_.now);
    return true;
  }

  /// Begins the way of a robot to its next action, its next gate, or the next progress that another robot
  /// waits for, whichever comes first. At a gate, makes it wait.
  void go_on(std::size_t robot, double t) {
    Traveller& one = travellers_[robot];
    one.heading_for = one.at;
    if (one.at >= one.end()) return;
    for (; one.next_gate < one.gates.size() && one.gates[one.next_gate].progress <= one.at; ++one.next_gate) {
      const std::size_t dependency = one.gates[one.next_gate].dependency;
      if (met_[dependency]) continue;
      waiting_[dependency] = robot;
      return;
    }
    if (one.action().profile) head_on(robot, t);
    one.now = t;
    double next = static_cast<double>(static_cast<std::size_t>(one.at)) + 1.0;
    if (one.next_gate < one.gates.size()) next = std::min(next, one.gates[one.next_gate].progress);
    if (one.next_awaited < one.awaited.size()) next = std::min(next, one.awaited[one.next_awaited].progress);
    one.heading_for = next;
    const double arrives = one.drive ? one.drive->time_at(one.place(next)) : t_reached(robot, next);
    arrivals_.emplace(arrives, robot, ++one.arrivals);
  }

  /// Lets a robot drive on: begins the drive if it has not begun. The robot heads for the first closed gate,
  /// or for the end.
  void head_on(std::size_t robot, double t) {
    Traveller& one = travellers_[robot];
    if (!one.drive) begin_drive(one, t);
    Drive& drive = *one.drive;
    if (drive.stands() && t > drive.now()) drive.stand_until(t);
    double stop = drive.length();
    // Bounded: each gate of a robot once, and the first closed gate whenever the robot goes on.
    for (; one.next_closed < one.gates.size(); ++one.next_closed) {
      const Mark& gate = one.gates[one.next_closed];
      if (gate.progress >= static_cast<double>(drive.end())) break;
      if (met_[gate.dependency]) continue;
      waiting_[gate.dependency] = robot;
      stop = one.place(gate.progress);
      break;
    }
    if (stop != drive.heading_for()) drive.head_for(stop);
  }

  void begin_drive(Traveller& one, double t) const {
    const auto index = static_cast<std::size_t>(one.at);
    const double fraction = one.at - std::floor(one.at);
    // A robot that waited, or is held, goes on from rest.
    const bool has_stood = t > one.now || t < one.held_until;
    const double speed = has_stood ? 0.0 : speed_at(one.action(), planned_time(one.actions, index, fraction));
    one.drive.emplace(one.actions, index, std::vector{one.speed_factor}, std::max(t, one.held_until), speed,
                      fraction);
  }

  /// A gate that a robot is heading for has opened.
  void drive_past(std::size_t robot, std::size_t opener, double t) {
    Traveller& one = travellers_[robot];
    one.drive->drive_until(t);
    const bool slowed_down = one.drive->slows_down();
    go_on(robot, t);
    if (slowed_down && !one.drive->slows_down()) blame(one, opener);
  }

  /// Notes that a robot has waited for another robot.
  void blame(Traveller& waiter, std::size_t robot) const {
    const std::size_t because_of = travellers_[robot].because_of;
    waiter.waits_for = robot;
    waiter.because_of = because_of == kNobody ? robot : because_of;
  }

  /// Returns when a robot gets from where it is to a progress in the same action, seconds.
  double t_reached(std::size_t robot, double progress) const {
    const Traveller& one = travellers_[robot];
    const Action& action = one.action();
    const Pace pace(one.actions);
    const double planned = pace.time_at(progress);
    const double from = action.t_start + (one.at - std::floor(one.at)) * (action.t_end - action.t_start);
    if (action.type != Action::Type::wait) {
      return std::max(one.now, one.held_until) + (planned - from) / one.speed_factor;
    }
    // A wait takes only its purpose, which lies at its end.
    const WaitPurpose& purpose = one.purposes[static_cast<std::size_t>(one.at)];
    const double left = std::min(action.t_end - from, purpose.least);
    const double earliest_end = purpose.not_before + purpose.least;
    const double end = std::max({one.now + left, earliest_end, action.goal ? 0.0 : action.t_end});
    return progress >= std::floor(one.at) + 1.0 ? end : std::max(one.now, std::min(end, planned));
  }

  void arrive(std::size_t robot, double t) {
    Traveller& one = travellers_[robot];
    const auto action = static_cast<std::size_t>(one.at);
    if (one.drive) one.drive->drive_to(one.place(one.heading_for));
    one.at = one.heading_for;
    one.now = t;
    if (one.drive && one.at >= static_cast<double>(one.drive->end())) one.drive.reset();
    if (one.at >= static_cast<double>(action) + 1.0) {
      RetimedRobot& retimed = retimed_[robot];
      retimed.ends[action - retimed.first] = t;
      note_lateness(robot, t - one.actions[action].t_end);
    }
    tell(robot, t);
    go_on(robot, t);
  }

  void note_lateness(std::size_t robot, double late) {
    Traveller& one = travellers_[robot];
    if (late <= kOnTime) {
      one.because_of = kNobody;
      one.waits_for = kNobody;
    } else if (one.because_of == kNobody) {
      one.because_of = robot;
    }
  }

  /// Marks the dependencies on a robot's progress as met, and lets the robots go on that waited for it.
  void tell(std::size_t robot, double t) {
    Traveller& one = travellers_[robot];
    for (; one.next_awaited < one.awaited.size() && one.awaited[one.next_awaited].progress <= one.at;
         ++one.next_awaited) {
      const std::size_t dependency = one.awaited[one.next_awaited].dependency;
      met_[dependency] = true;
      const std::size_t other = waiting_[dependency];
      if (other == kNobody) continue;
      waiting_[dependency] = kNobody;
      Traveller& waiter = travellers_[other];
      if (waiter.drive && !waiter.drive->stands()) {
        drive_past(other, robot, t);
        continue;
      }
      if (t > waiter.now + kOnTime) blame(waiter, robot);
      go_on(other, t);
    }
  }

  void finish(std::size_t robot) {
    const Traveller& one = travellers_[robot];
    RetimedRobot& retimed = retimed_[robot];
    if (retimed.ends.empty()) return;
    retimed.delay = retimed.ends.back() - one.actions.back().t_end;
    if (retimed.delay <= kOnTime) return;
    if (one.waits_for != kNobody) retimed.waits_for = one.waits_for;
    retimed.because_of = one.because_of == kNobody ? robot : one.because_of;
  }

  const std::vector<Dependency>& dependencies_;
  const RetimeRules& rules_;
  std::vector<Traveller> travellers_;
  std::vector<char> met_;             // by dependency
  std::vector<std::size_t> waiting_;  // by dependency
  std::vector<RetimedRobot> retimed_;
  std::priority_queue<Arrival, std::vector<Arrival>, std::greater<>> arrivals_;
};

}  // namespace

std::optional<std::vector<RetimedRobot>> retime(const std::vector<Robot>& robots,
                                                const std::vector<Actions>& actions,
                                                const std::vector<Dependency>& dependencies,
                                                const std::vector<ObservedState>& states,
                                                const RetimeRules& rules, const StopCondition& stop) {
  return Forward(robots, actions, dependencies, states, rules).run(stop);
}

}  // namespace fleetplan::core
