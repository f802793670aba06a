#pragma once

// Robots that execute plans at their own pace: random speeds and stops, with or without regard to
// dependencies. It knows only actions and dependencies.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <queue>
#include <utility>
#include <vector>

#include "core/execution/dependencies.h"
#include "core/execution/executed_actions.h"
#include "core/geometry/position.h"
#include "core/model/plan.h"
#include "tests/support/random_problem.h"

namespace fleetplan::support {

/// The outcome of an execution.
struct OwnPace {
  std::vector<core::RobotPlan> executed;  // by every robot that has actions
  bool everyone_arrived = true;
};

class OwnPaceExecution {
 public:
  OwnPaceExecution(Dice& dice, std::vector<core::Actions> actions,
                   const std::vector<core::Dependency>& dependencies)
      : dice_(dice), dependencies_(dependencies), drivers_(actions.size()) {
    for (std::size_t robot = 0; robot < actions.size(); ++robot) drivers_[robot].actions = actions[robot];
    for (std::size_t k = 0; k < dependencies.size(); ++k) {
      for (const core::ActionProgress* one : {&dependencies[k].gate, &dependencies[k].until}) {
        drivers_[one->robot].marks.push_back(whole(*one));
      }
      drivers_[dependencies[k].gate.robot].gates.push_back(k);
    }
    for (Driver& driver : drivers_) {
      std::sort(driver.marks.begin(), driver.marks.end());
      driver.slowness = dice_.between(0.0, 1.0);
    }
  }

  OwnPace run() {
    for (std::size_t robot = 0; robot < drivers_.size(); ++robot) set_off(robot, 0.0);
    while (!events_.empty()) {
      const auto [t, robot] = events_.top();
      events_.pop();
      arrive(robot, t);
    }
    OwnPace done;
    for (std::size_t robot = 0; robot < drivers_.size(); ++robot) {
      Driver& driver = drivers_[robot];
      if (driver.actions.empty()) continue;
      done.everyone_arrived = done.everyone_arrived && driver.at >= end_of(driver);
      const double cost = driver.executed.empty() ? 0.0 : driver.executed.back().t_end;
      done.executed.push_back({robot, cost, std::move(driver.executed)});
    }
    return done;
  }

 private:
  struct Driver {
    core::Actions actions;
    std::vector<double> marks;       // gates and what others wait for, whole progress, ascending
    std::vector<std::size_t> gates;  // dependencies
    double slowness = 0.0;
    double at = 0.0;
    double next = 0.0;  // where it is driving to
    std::vector<core::Action> executed = {};
    double now = 0.0;  // the end of what it has executed
    bool waits = false;
  };
  using Event = std::pair<double, std::size_t>;

  static double whole(const core::ActionProgress& progress) {
    return static_cast<double>(progress.action) + progress.fraction;
  }
  static double end_of(const Driver& driver) { return static_cast<double>(driver.actions.size()); }

  bool may_pass(const Driver& driver) const {
    return std::all_of(driver.gates.begin(), driver.gates.end(), [&](std::size_t k) {
      const core::Dependency& one = dependencies_[k];
      return driver.at < whole(one.gate) || drivers_[one.until.robot].at >= whole(one.until);
    });
  }

  core::Pose pose_at(const Driver& driver, double progress) const {
    const auto last = static_cast<double>(driver.actions.size() - 1);
    const double index = std::clamp(std::floor(progress), 0.0, last);
    const core::Action& action = driver.actions[static_cast<std::size_t>(index)];
    const double share = std::min(1.0, progress - index);
    if (share >= 1.0) return action.to;
    core::Pose pose = action.from;
    pose.position += share * (action.to.position - action.from.position);
    pose.theta = core::normalize_angle(pose.theta +
                                       share * core::rotation_between(action.from.theta, action.to.theta));
    return pose;
  }

  void execute(Driver& driver, core::Action::Type type, double seconds, const core::Pose& to) {
    const core::Pose from = driver.executed.empty() ? pose_at(driver, 0.0) : driver.executed.back().to;
    driver.executed.push_back({type, driver.now, driver.now + seconds, from, to});
    driver.now += seconds;
  }

  void set_off(std::size_t robot, double t) {
    Driver& driver = drivers_[robot];
    if (driver.at >= end_of(driver)) return;
    driver.waits = !may_pass(driver);
    if (driver.waits) return;
    const core::Pose here = pose_at(driver, driver.at);
    if (t > driver.now) execute(driver, core::Action::Type::wait, t - driver.now, here);
    if (dice_.chance(0.1 * driver.slowness)) {
      execute(driver, core::Action::Type::wait, dice_.between(0.0, 20.0), here);
    }
    const auto mark = std::upper_bound(driver.marks.begin(), driver.marks.end(), driver.at);
    const core::Action& action = driver.actions[static_cast<std::size_t>(std::floor(driver.at))];
    double next = std::floor(driver.at) + 1.0;
    if (mark != driver.marks.end()) next = std::min(next, *mark);
    if (dice_.chance(0.3)) next = std::min(next, driver.at + dice_.between(0.01, 1.0));
    const double planned = (next - driver.at) * (action.t_end - action.t_start);
    const bool skipped = action.type == core::Action::Type::wait && !action.goal;
    // From almost standing to half as fast again as planned.
    const double speed = driver.slowness < 0.3 ? 1.5 : std::pow(100.0, dice_.between(-driver.slowness, 0.0));
    driver.next = next;
    execute(driver, action.type, skipped ? 0.0 : planned / speed, pose_at(driver, next));
    events_.push({driver.now, robot});
  }

  void arrive(std::size_t robot, double t) {
    drivers_[robot].at = drivers_[robot].next;
    set_off(robot, t);
    for (std::size_t other = 0; other < drivers_.size(); ++other) {
      if (drivers_[other].waits) set_off(other, t);
    }
  }

  Dice& dice_;
  const std::vector<core::Dependency>& dependencies_;
  std::vector<Driver> drivers_;
  std::priority_queue<Event, std::vector<Event>, std::greater<>> events_;
};

}  // namespace fleetplan::support
