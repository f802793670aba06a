#include "core/verify/motion_rules.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "core/geometry/angle.h"
#include "core/verify/wording.h"

namespace fleetplan::core {
namespace {

using Kind = Violation::Kind;

// Squares and products of such numbers stay far from overflow; the slowest robot on the longest way of the
// largest map takes less.
constexpr double kLargestUsable = 1e30;

bool usable(double number) { return std::abs(number) <= kLargestUsable; }  // false for NaN too

bool usable(const Pose& pose) {
  return usable(pose.position.x()) && usable(pose.position.y()) && usable(pose.theta);
}

std::string name_of(std::size_t action) { return "actions[" + std::to_string(action) + "]"; }

double distance_between(const Pose& a, const Pose& b) { return (b.position - a.position).norm(); }

double turn_between(const Pose& a, const Pose& b) { return std::abs(rotation_between(a.theta, b.theta)); }

/// Goes through the actions of one plan and gathers what is wrong.
class MotionCheck {
 public:
  MotionCheck(const Robot& robot, const RobotPlan& plan, double tolerance)
      : robot_(robot), plan_(plan), tolerance_(tolerance) {}

  std::vector<Violation> run() {
    for (std::size_t k = 0; k < plan_.actions.size(); ++k) {
      check_when_it_begins(k);
      if (k > 0) check_where_it_begins(k);
      check_what_it_does(k);
      check_how_fast(k);
    }
    check_cost();
    return std::move(violations_);
  }

 private:
  bool differ(double a, double b) const { return std::abs(a - b) > tolerance_; }

  void report(Kind kind, double t, double distance, double required, const std::string& detail) {
    violations_.push_back({kind, {plan_.robot}, t, distance, required, detail});
  }

  void check_when_it_begins(std::size_t k) {
    const Action& action = plan_.actions[k];
    const double due = k == 0 ? 0.0 : plan_.actions[k - 1].t_end;
    if (differ(action.t_start, due)) {
      report(Kind::discontinuity, action.t_start, action.t_start, due,
             name_of(k) + " starts at t = " + seconds(action.t_start) +
                 (k == 0 ? ", but a plan starts at t = " : ", but the action before ends at t = ") +
                 seconds(due));
    }
    if (action.t_end < action.t_start - tolerance_) {
      report(Kind::discontinuity, action.t_start, action.t_end, action.t_start,
             name_of(k) + " ends at t = " + seconds(action.t_end) +
                 ", before it starts at t = " + seconds(action.t_start));
    }
  }

  void check_where_it_begins(std::size_t k) {
    const Action& action = plan_.actions[k];
    const Pose& before = plan_.actions[k - 1].to;
    const double jump = distance_between(before, action.from);
    if (jump > tolerance_) {
      report(Kind::discontinuity, action.t_start, jump, 0.0,
             name_of(k) + " starts " + metres(jump) + " from where the action before ends");
    }
    const double turn = turn_between(before, action.from);
    if (turn > tolerance_) {
      report(Kind::discontinuity, action.t_start, turn, 0.0,
             name_of(k) + " starts with a heading " + radians(turn) +
                 " from that with which the action before ends");
    }
  }

  void check_what_it_does(std::size_t k) {
    const Action& action = plan_.actions[k];
    const double way = distance_between(action.from, action.to);
    if (action.type != Action::Type::translate && way > tolerance_) {
      report(Kind::discontinuity, action.t_start, way, 0.0,
             name_of(k) +
                 (action.type == Action::Type::wait ? " waits, but moves by " : " rotates, but moves by ") +
                 metres(way));
    }
    const double turn = turn_between(action.from, action.to);
    if (action.type != Action::Type::rotate && turn > tolerance_) {
      report(
          Kind::discontinuity, action.t_start, turn, 0.0,
          name_of(k) +
              (action.type == Action::Type::wait ? " waits, but turns by " : " translates, but turns by ") +
              radians(turn));
    }
  }

  void check_how_fast(std::size_t k) {
    const Action& action = plan_.actions[k];
    if (action.type == Action::Type::translate) {
      check_duration(k, distance_between(action.from, action.to), robot_.linear_speed, "m/s");
      check_direction(k);
    } else if (action.type == Action::Type::rotate) {
      check_duration(k, turn_between(action.from, action.to), robot_.angular_speed, "rad/s");
    }
  }

  /// An action that takes less time than it must, or leads further than it can: what is off by no more than
  /// the tolerance in one of the two is fine, as a slow robot's poses that are rounded mean much time.
  /// Infinite speeds are told as durations instead.
  void check_duration(std::size_t k, double amount, double top_speed, const char* unit) {
    const Action& action = plan_.actions[k];
    const double duration = std::max(0.0, action.t_end - action.t_start);
    const double least =
        std::min(amount / top_speed, std::numeric_limits<double>::max());  // even if denormal
    if (duration >= least - tolerance_ || duration * top_speed >= amount - tolerance_) return;
    const double speed = amount / duration;
    if (usable(speed)) {
      report(Kind::speed, action.t_start, speed, top_speed,
             name_of(k) + " goes at " + in_words(speed, unit) + ", but the robot can do no more than " +
                 in_words(top_speed, unit));
    } else {
      report(Kind::speed, action.t_start, duration, least,
             name_of(k) + " takes " + seconds(duration) + ", but the robot needs at least " + seconds(least));
    }
  }

  /// Judged by how far a translation leads off the line of its heading, so that very short ones may be
  /// rounded.
  void check_direction(std::size_t k) {
    const Action& action = plan_.actions[k];
    const Position way = action.to.position - action.from.position;
    const double theta = action.from.theta;
    const double sideways = std::abs(way.x() * std::sin(theta) - way.y() * std::cos(theta));
    if (sideways > tolerance_) {
      report(Kind::speed, action.t_start, sideways, 0.0,
             name_of(k) + " moves " + metres(sideways) +
                 " sideways, but the robot can only move along its heading");
    }
  }

  void check_cost() {
    const double end = plan_.actions.empty() ? 0.0 : plan_.actions.back().t_end;
    if (!differ(plan_.cost, end)) return;
    report(Kind::discontinuity, end, plan_.cost, end,
           "the cost is " + seconds(plan_.cost) +
               (plan_.actions.empty() ? ", but there are no actions" : ", but the last action ends at t = ") +
               (plan_.actions.empty() ? "" : seconds(end)));
  }

  const Robot& robot_;
  const RobotPlan& plan_;
  double tolerance_;
  std::vector<Violation> violations_;
};

}  // namespace

std::optional<Violation> find_unusable_number(std::size_t index, const Robot& robot, const RobotPlan* plan) {
  const auto violation = [index](double t, const std::string& what) {
    return Violation{Kind::discontinuity,
                     {index},
                     t,
                     0.0,
                     0.0,
                     what +
                         " has a number that is not finite or larger than 1e30; the robot is left out of "
                         "all other checks"};
  };
  const bool goal_usable =
      !robot.goal || (usable(robot.goal->position.x()) && usable(robot.goal->position.y()) &&
                      usable(robot.goal->theta.value_or(0.0)));
  if (!goal_usable || !usable(robot.start) || !usable(robot.radius) || !usable(robot.linear_speed) ||
      !usable(robot.angular_speed)) {
    return violation(0.0, "the robot");
  }
  if (plan == nullptr) return std::nullopt;
  double latest = 0.0;  // the last time before the unusable number that is a time
  for (std::size_t k = 0; k < plan->actions.size(); ++k) {
    const Action& action = plan->actions[k];
    if (!usable(action.t_start) || !usable(action.t_end) || !usable(action.from) || !usable(action.to)) {
      return violation(latest, name_of(k));
    }
    latest = action.t_end;
  }
  if (!usable(plan->cost)) return violation(latest, "the cost");
  return std::nullopt;
}

std::vector<Violation> check_motion(const Robot& robot, const RobotPlan& plan, double tolerance) {
  return MotionCheck(robot, plan, tolerance).run();
}

}  // namespace fleetplan::core
