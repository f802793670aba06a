#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "core/geometry/elementary_functions.h"
#include "core/geometry/position.h"
#include "core/verify/rules/robot_rules.h"

namespace fleetplan::core {
namespace {

using Kind = Violation::Kind;

// The largest number of a plan that can be checked. Squares and products of such numbers stay far from
// overflow; even the slowest robot on the longest path of the largest map takes less time.
constexpr double kLargestUsable = 1e30;

constexpr std::size_t kActionsBetweenPolls = 64;

bool usable(double number) { return std::abs(number) <= kLargestUsable; }  // false for NaN too

bool usable(const Pose& pose) {
  return usable(pose.position.x()) && usable(pose.position.y()) && usable(pose.theta);
}

bool usable_action(const Action& action) {
  return usable(action.t_start) && usable(action.t_end) && usable(action.from) && usable(action.to);
}

bool goals_usable(const Robot& robot) {
  for (std::size_t k = 0; k < robot.goal_count(); ++k) {
    const Goal& goal = robot.goal_at(k);
    if (!usable(goal.position.x()) || !usable(goal.position.y()) || !usable(goal.theta.value_or(0.0)) ||
        !usable(goal.service) || !usable(goal.not_before)) {
      return false;
    }
  }
  return true;
}

std::string action_name(std::size_t action) { return "actions[" + std::to_string(action) + "]"; }

double distance_between(const Pose& a, const Pose& b) { return (b.position - a.position).norm(); }

double turn_between(const Pose& a, const Pose& b) { return std::abs(rotation_between(a.theta, b.theta)); }

bool goes_on_straight(const Action& before, const Action& action, const Tolerance& tolerance) {
  if (before.type != Action::Type::translate) return false;
  if (action.t_start - before.t_end > tolerance.seconds) return false;
  if (std::abs(rotation_between(before.to.theta, action.from.theta)) > tolerance.radians) return false;
  const Position earlier = before.to.position - before.from.position;
  const Position later = action.to.position - action.from.position;
  return earlier.dot(later) >= 0.0;  // they lead ahead, not back
}

/// Checks the actions of one plan in order.
class MotionCheck {
 public:
  MotionCheck(const Robot& robot, const RobotPlan& plan, const CarriedLoads& loads,
              const Tolerance& tolerance)
      : robot_(robot), plan_(plan), loads_(loads), tolerance_(tolerance) {}

  ViolationList run(std::size_t given, const StopCondition& stop) {
    StopStride stride = StopStride::from_first(stop, kActionsBetweenPolls);
    for (std::size_t k = given; k < plan_.actions.size() && !stride.met_at_step(); ++k) {
      check_times(k);
      if (k > 0) check_start_pose(k);
      check_type(k);
      check_speed(k);
      if (k >= robot_.committed.size()) check_profile(k);  // committed motion may be measured
    }
    check_cost();
    return std::move(violations_);
  }

 private:
  bool differ(double a, double b) const { return std::abs(a - b) > tolerance_.seconds; }

  void report(Kind kind, double t, double distance, double required, const std::string& detail) {
    violations_.add(Violation{.kind = kind,
                              .robots = {plan_.robot},
                              .t = t,
                              .distance = distance,
                              .required = required,
                              .detail = detail});
  }

  void check_times(std::size_t k) {
    const Action& action = plan_.actions[k];
    const double required = k == 0 ? 0.0 : plan_.actions[k - 1].t_end;
    if (differ(action.t_start, required)) {
      report(Kind::discontinuity, action.t_start, action.t_start, required,
             action_name(k) + " starts at t = " + seconds(action.t_start) +
                 (k == 0 ? ", but a plan starts at t = " : ", but the action before ends at t = ") +
                 seconds(required));
    }
    if (action.t_end < action.t_start - tolerance_.seconds) {
      report(Kind::discontinuity, action.t_start, action.t_end, action.t_start,
             action_name(k) + " ends at t = " + seconds(action.t_end) +
                 ", before it starts at t = " + seconds(action.t_start));
    }
  }

  void check_start_pose(std::size_t k) {
    const Action& action = plan_.actions[k];
    const Pose& before = plan_.actions[k - 1].to;
    const double jump = distance_between(before, action.from);
    if (jump > tolerance_.metres) {
      report(Kind::discontinuity, action.t_start, jump, 0.0,
             action_name(k) + " starts " + metres(jump) + " from where the action before ends");
    }
    const double turn = turn_between(before, action.from);
    if (turn > tolerance_.radians) {
      report(Kind::discontinuity, action.t_start, turn, 0.0,
             action_name(k) + " starts with a heading " + radians(turn) +
                 " from that with which the action before ends");
    }
  }

  void check_type(std::size_t k) {
    const Action& action = plan_.actions[k];
    const double distance = distance_between(action.from, action.to);
    if (action.type != Action::Type::translate && distance > tolerance_.metres) {
      report(Kind::discontinuity, action.t_start, distance, 0.0,
             action_name(k) +
                 (action.type == Action::Type::wait ? " waits, but moves by " : " rotates, but moves by ") +
                 metres(distance));
    }
    const double turn = turn_between(action.from, action.to);
    if (action.type != Action::Type::rotate && turn > tolerance_.radians) {
      report(
          Kind::discontinuity, action.t_start, turn, 0.0,
          action_name(k) +
              (action.type == Action::Type::wait ? " waits, but turns by " : " translates, but turns by ") +
              radians(turn));
    }
  }

  void check_speed(std::size_t k) {
    const Action& action = plan_.actions[k];
    if (action.type == Action::Type::translate) {
      check_duration(k, distance_between(action.from, action.to), loads_.at(action.t_start).linear_speed,
                     tolerance_.metres, "m/s");
      check_direction(k);
    } else if (action.type == Action::Type::rotate) {
      check_duration(k, turn_between(action.from, action.to), robot_.angular_speed, tolerance_.radians,
                     "rad/s");
    }
  }

  /// Reports an action that takes less time than necessary by more than the tolerance, and leads farther than
  /// possible by more than the tolerance. Both are required, because for a slow robot, rounded poses may
  /// amount to much time. Infinite speeds are reported as durations.
  void check_duration(std::size_t k, double amount, double top_speed, double tolerance, const char* unit) {
    const Action& action = plan_.actions[k];
    const double duration = std::max(0.0, action.t_end - action.t_start);
    const double least =
        std::min(amount / top_speed, std::numeric_limits<double>::max());  // finite for denormal speeds
    if (duration >= least - tolerance_.seconds || duration * top_speed >= amount - tolerance) return;
    const double speed = amount / duration;
    if (usable(speed)) {
      report(Kind::speed, action.t_start, speed, top_speed,
             action_name(k) + " goes at " + quantity_text(speed, unit) +
                 ", but the robot can do no more than " + quantity_text(top_speed, unit));
    } else {
      report(Kind::speed, action.t_start, duration, least,
             action_name(k) + " takes " + seconds(duration) + ", but the robot needs at least " +
                 seconds(least));
    }
  }

  /// Checks the profile of a translation or rotation, by the laws of constant acceleration.
  void check_profile(std::size_t k) {
    const Action& action = plan_.actions[k];
    if (action.type == Action::Type::wait) return;
    const bool turns = action.type == Action::Type::rotate;
    const double amount =
        turns ? turn_between(action.from, action.to) : distance_between(action.from, action.to);
    const double tolerance = turns ? tolerance_.radians : tolerance_.metres;
    const CarriedLoad& load = loads_.at(action.t_start);
    const double gain = turns ? robot_.angular_acceleration : load.linear_acceleration;
    const double loss = turns ? robot_.angular_acceleration : load.linear_deceleration;
    const bool is_limited = std::isfinite(gain) || std::isfinite(loss);
    if (!action.profile) {
      if (is_limited && amount > tolerance) {
        report(Kind::profile, action.t_start, 0.0, 0.0,
               action_name(k) + " has no profile, but the robot's acceleration is limited");
      }
      return;
    }
    const SpeedProfile& profile = *action.profile;
    const double top_speed = turns ? robot_.angular_speed : load.linear_speed;
    const auto fault = [&](double value, double required, const std::string& what) {
      report(Kind::profile, action.t_start, value, required, action_name(k) + " has a profile " + what);
    };
    if (!usable(profile.start) || !usable(profile.cruise) || !usable(profile.end)) {
      return fault(0.0, 0.0, "with a number that is not finite or larger than 1e30");
    }
    if (profile.cruise > top_speed + tolerance)
      return fault(profile.cruise, top_speed, "faster than the robot");
    const double least = std::min(profile.start, profile.end);
    const double most = std::max(profile.start, profile.end);
    if (least < -tolerance || most > profile.cruise + tolerance) {
      return fault(least < -tolerance ? least : most, least < -tolerance ? 0.0 : profile.cruise,
                   "whose speed at an end is negative or greater than in the middle");
    }
    check_covered(k, profile, {gain, loss}, amount, tolerance);
    const bool goes_on = k > 0 && !turns && goes_on_straight(plan_.actions[k - 1], action, tolerance_);
    const double before = goes_on && k > robot_.committed.size() ? end_speed(k - 1) : 0.0;
    if (std::abs(profile.start - before) > tolerance) {
      fault(profile.start, before, "that does not begin at the speed before");
    }
    const bool ends = k + 1 == plan_.actions.size() ||
                      !goes_on_straight(action, plan_.actions[k + 1], tolerance_) ||
                      plan_.actions[k + 1].type != Action::Type::translate;
    if (ends && profile.end > tolerance) fault(profile.end, 0.0, "that does not end at rest");
  }

  double end_speed(std::size_t k) const {
    const Action& action = plan_.actions[k];
    return action.profile ? action.profile->end : 0.0;
  }

  /// The greatest changes of speed, metres (or radians) per second squared.
  struct Limits {
    double gain;
    double loss;
  };

  /// Reports a profile that covers another length (or angle) than its action, or that takes more time.
  void check_covered(std::size_t k, const SpeedProfile& profile, const Limits& limits, double amount,
                     double tolerance) {
    const Action& action = plan_.actions[k];
    const double gaining = (profile.cruise - profile.start) / limits.gain;
    const double losing = (profile.cruise - profile.end) / limits.loss;
    const double duration = action.t_end - action.t_start;
    if (duration < gaining + losing - tolerance_.seconds) {
      report(Kind::profile, action.t_start, duration, gaining + losing,
             action_name(k) + " takes " + seconds(duration) +
                 ", but the changes of speed of its profile take " + seconds(gaining + losing));
      return;
    }
    const double cruising = duration - gaining - losing;
    const double covered = 0.5 * (profile.start + profile.cruise) * gaining + profile.cruise * cruising +
                           0.5 * (profile.cruise + profile.end) * losing;
    if (std::abs(covered - amount) <= tolerance + profile.cruise * tolerance_.seconds) return;
    report(Kind::profile, action.t_start, covered, amount,
           action_name(k) + " has a profile that covers " + std::to_string(covered) + ", but goes " +
               std::to_string(amount));
  }

  /// Measures how far a translation leads off the line of its heading, so that very short ones may be
  /// rounded.
  void check_direction(std::size_t k) {
    const Action& action = plan_.actions[k];
    const Position d = action.to.position - action.from.position;
    const Position ahead = unit_vector(action.from.theta);
    const double sideways = std::abs(cross_product(ahead, d));
    if (sideways > tolerance_.metres) {
      report(Kind::speed, action.t_start, sideways, 0.0,
             action_name(k) + " moves " + metres(sideways) +
                 " sideways, but the robot can only move along its heading");
    }
    if (action.reverse) check_reverse(k, ahead.dot(d));
  }

  /// Reports a translation in the wrong direction. `ahead`: how far it leads along the heading, metres.
  void check_reverse(std::size_t k, double ahead) {
    const double t = plan_.actions[k].t_start;
    if (!robot_.may_reverse) {
      report(Kind::speed, t, -ahead, 0.0, action_name(k) + " reverses, but the robot may not");
    } else if (ahead > tolerance_.metres) {
      report(Kind::speed, t, ahead, 0.0, action_name(k) + " reverses, but moves " + metres(ahead) + " ahead");
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
  const CarriedLoads& loads_;
  Tolerance tolerance_;
  ViolationList violations_;
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
  if (!goals_usable(robot) || !std::all_of(robot.committed.begin(), robot.committed.end(), usable_action) ||
      !usable(robot.start) || !usable(robot.radius) || !usable(robot.linear_speed) ||
      !usable(robot.angular_speed)) {
    return violation(0.0, "the robot");
  }
  if (plan == nullptr) return std::nullopt;
  double latest = 0.0;  // the last time before the unusable number that is a time
  for (std::size_t k = 0; k < plan->actions.size(); ++k) {
    const Action& action = plan->actions[k];
    if (!usable_action(action)) {
      return violation(latest, action_name(k));
    }
    latest = action.t_end;
  }
  if (!usable(plan->cost)) return violation(latest, "the cost");
  return std::nullopt;
}

ViolationList check_motion(const Robot& robot, const RobotPlan& plan, std::size_t given,
                           const CarriedLoads& loads, const Tolerance& tolerance, const StopCondition& stop) {
  return MotionCheck(robot, plan, loads, tolerance).run(given, stop);
}

ViolationList check_waits(const Robot& robot, const RobotPlan& plan, double wait, const Tolerance& tolerance,
                          const StopCondition& stop) {
  ViolationList violations;
  if (wait <= 0.0) return violations;
  const std::vector<Action>& actions = plan.actions;
  // The time since which the robot stands, and whether it may have stood before t = 0.
  double since = 0.0;
  bool open = !robot.committed.empty() && !actions.empty() && actions.front().type == Action::Type::wait;
  StopStride stride = StopStride::from_first(stop, kActionsBetweenPolls);
  for (std::size_t k = 0; k < actions.size() && !stride.met_at_step(); ++k) {
    const Action& action = actions[k];
    if (action.type == Action::Type::wait) continue;
    const double stood = action.t_start - since;
    const bool judged = action.type == Action::Type::translate && k >= robot.committed.size() && !open &&
                        (k == 0 || !goes_on_straight(actions[k - 1], action, tolerance));
    if (judged && stood < wait - tolerance.seconds) {
      violations.add({Violation::Kind::speed,
                      {plan.robot},
                      action.t_start,
                      stood,
                      wait,
                      "actions[" + std::to_string(k) + "] follows a stand-still of " + seconds(stood) +
                          ", but robots wait " + seconds(wait) + " before they move",
                      {}});
    }
    since = action.t_end;
    open = false;
  }
  return violations;
}

namespace {

/// A number of an action, and the same number of the committed one.
struct Comparison {
  const char* what;
  double difference;
  double tolerance;
  const char* unit;
};

/// Returns the first difference that is larger than its tolerance; none if there is none.
std::optional<Comparison> difference(const Action& action, const Action& committed,
                                     const Tolerance& tolerance) {
  const auto position = [](const Pose& a, const Pose& b) {
    return std::max(std::abs(a.position.x() - b.position.x()), std::abs(a.position.y() - b.position.y()));
  };
  const auto heading = [](const Pose& a, const Pose& b) {
    return a.theta == b.theta ? 0.0 : std::abs(rotation_between(a.theta, b.theta));
  };
  for (const Comparison& comparison :
       {Comparison{"begins", std::abs(action.t_start - committed.t_start), tolerance.seconds, "s"},
        Comparison{"ends", std::abs(action.t_end - committed.t_end), tolerance.seconds, "s"},
        Comparison{"begins", position(action.from, committed.from), tolerance.metres, "m"},
        Comparison{"ends", position(action.to, committed.to), tolerance.metres, "m"},
        Comparison{"begins with a heading", heading(action.from, committed.from), tolerance.radians, "rad"},
        Comparison{"ends with a heading", heading(action.to, committed.to), tolerance.radians, "rad"}}) {
    if (comparison.difference > comparison.tolerance) return comparison;
  }
  return std::nullopt;
}

}  // namespace

std::optional<Violation> check_commitments(const Robot& robot, const RobotPlan& plan,
                                           const Tolerance& tolerance, bool exact) {
  const Tolerance allowed = exact ? Tolerance{} : tolerance;
  Violation violation{Violation::Kind::committed_changed, {plan.robot}, 0.0, 0.0, 0.0, "", {}};
  for (std::size_t k = 0; k < robot.committed.size(); ++k) {
    const Action& committed = robot.committed[k];
    violation.t = committed.t_start;
    if (k >= plan.actions.size()) {
      violation.distance = static_cast<double>(plan.actions.size());
      violation.required = static_cast<double>(robot.committed.size());
      violation.detail = "the plan has " + std::to_string(plan.actions.size()) + " actions, but " +
                         std::to_string(robot.committed.size()) + " are committed";
      return violation;
    }
    const std::string action = "actions[" + std::to_string(k) + "]";
    if (plan.actions[k].type != committed.type) {
      violation.detail = action + " has another type than the committed action";
      return violation;
    }
    if (const auto changed = difference(plan.actions[k], committed, allowed)) {
      violation.distance = changed->difference;
      violation.detail = action + " " + changed->what + " " +
                         quantity_text(changed->difference, changed->unit) + " off the committed action";
      return violation;
    }
  }
  return std::nullopt;
}

}  // namespace fleetplan::core
