#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include "core/geometry/position.h"
#include "core/geometry/segment.h"
#include "core/geometry/tolerance.h"
#include "core/verify/rules/robot_rules.h"

namespace fleetplan::core {
namespace {

/// Compares a pose with the required one. The detail begins with `what` and names the required pose `which`.
std::optional<Violation> check_pose(const Violation& blank, const Pose& pose, const Goal& required,
                                    const Tolerance& tolerance, const std::string& what,
                                    const std::string& which) {
  Violation violation = blank;
  const double away = (pose.position - required.position).norm();
  if (away > tolerance.metres) {
    violation.distance = away;
    violation.detail = what + " " + metres(away) + " from the robot's " + which;
    return violation;
  }
  const double turn = required.theta ? std::abs(rotation_between(pose.theta, *required.theta)) : 0.0;
  if (turn > tolerance.radians) {
    violation.distance = turn;
    violation.detail = what + " with a heading " + radians(turn) + " from that of the robot's " + which;
    return violation;
  }
  return std::nullopt;
}

}  // namespace

std::vector<Violation> check_terminals(const Robot& robot, const RobotPlan& plan, const Tolerance& tolerance,
                                       GoalsLeft goals_left) {
  std::vector<Violation> violations;
  const bool stays = plan.actions.empty();
  if (!stays) {
    const Violation blank{Violation::Kind::wrong_start, {plan.robot}, 0.0, 0.0, 0.0, "", {}};
    const Goal start{robot.start.position, robot.start.theta};
    const auto wrong =
        check_pose(blank, plan.actions.front().from, start, tolerance, "the plan starts", "start");
    if (wrong) violations.push_back(*wrong);
  }
  if (goals_left == GoalsLeft::allowed || robot.yields()) return violations;
  const Violation blank{
      Violation::Kind::wrong_goal, {plan.robot}, stays ? 0.0 : plan.actions.back().t_end, 0.0, 0.0, "", {}};
  const Pose& rest = stays ? robot.start : plan.actions.back().to;
  const Goal required = robot.goal.value_or(Goal{robot.committed_end().position, std::nullopt});
  const std::string place = robot.goal ? "goal" : "start, where it is parked";
  const auto wrong = check_pose(blank, rest, required, tolerance, "the plan ends", place);
  if (wrong) violations.push_back(*wrong);
  return violations;
}

namespace {

constexpr std::size_t kRestsBetweenPolls = 64;

/// An interval, from t_begin to t_end (infinity: the end of its plan), in which the robot neither moves nor
/// turns.
struct Rest {
  double t_begin = 0.0;
  double t_end = 0.0;
  Pose pose;
};

std::vector<Rest> rests_of(const Robot& robot, const RobotPlan& plan) {
  std::vector<Rest> rests{{0.0, 0.0, robot.start}};
  for (const Action& action : plan.actions) {
    const double t_end = std::max(rests.back().t_end, action.t_end);
    if (action.type == Action::Type::wait) {
      rests.back().t_end = t_end;
    } else {
      rests.push_back({t_end, t_end, action.to});
    }
  }
  return rests;
}

std::string goal_name(std::size_t goal) { return "goals[" + std::to_string(goal) + "]"; }

class VisitCheck {
 public:
  VisitCheck(const Robot& robot, const RobotPlan& plan, const Tolerance& tolerance, GoalsLeft goals_left,
             const StopCondition& stop)
      : robot_(robot),
        plan_(plan),
        tolerance_(tolerance),
        goals_left_(goals_left),
        stop_(stop),
        rests_(rests_of(robot, plan)) {
    // A robot that is as near to a pose as this is in it.
    tolerance_.metres = std::max(tolerance_.metres, kContactTolerance);
    tolerance_.radians = std::max(tolerance_.radians, kContactTolerance);
  }

  std::vector<Violation> run() {
    if (!robot_.goal) return {};
    serve();
    check_claims();
    check_labels();
    return std::move(violations_);
  }

  /// Counts the served goals, without the last goal.
  std::size_t count_served() {
    serve();
    return served_.size();
  }

 private:
  /// A service at a goal. It has an end at the last goal, too.
  struct Service {
    double arrives = 0.0;
    double ends = 0.0;
  };

  std::size_t last_goal() const { return robot_.via.size(); }

  double distance(const Pose& pose, std::size_t goal) const {
    if (robot_.goal_at(goal).anywhere) return 0.0;
    return (pose.position - robot_.goal_at(goal).position).norm();
  }
  bool is_in_pose(const Pose& pose, std::size_t goal) const {
    const std::optional<double>& theta = robot_.goal_at(goal).theta;
    return distance(pose, goal) <= tolerance_.metres &&
           (!theta || std::abs(rotation_between(pose.theta, *theta)) <= tolerance_.radians);
  }

  /// Serves one goal after the other, each as early as possible.
  void serve() {
    StopStride stride = StopStride::from_first(stop_, kRestsBetweenPolls);
    for (std::size_t k = 0; k < rests_.size() && served_.size() < last_goal(); ++k) {
      if (stride.met_at_step()) return;
      const Rest& rest = rests_[k];
      double now = rest.t_begin;
      while (served_.size() < last_goal() && is_in_pose(rest.pose, served_.size())) {
        const Goal& goal = robot_.goal_at(served_.size());
        const double end = std::max(now, goal.not_before) + goal.service;
        // A robot that ends its plan here stands for ever, but its plan has to contain the service.
        if (end > rest.t_end + tolerance_.seconds) break;
        served_.push_back({now, end});
        now = end;
      }
    }
    if (goals_left_ == GoalsLeft::allowed) return;
    if (served_.size() < last_goal()) {
      report_missing(served_.size());
    } else {
      serve_last();
    }
  }

  void serve_last() {
    const Rest& rest = rests_.back();
    const Goal& goal = *robot_.goal;
    double now = rest.t_begin;
    if (!served_.empty()) now = std::max(now, served_.back().ends);
    const double end = std::max(now, goal.not_before) + goal.service;
    served_.push_back({now, kForever});
    if (end <= rest.t_end + tolerance_.seconds) return;
    report(rest.t_end, rest.t_end, end,
           "the plan ends at t = " + seconds(rest.t_end) + ", but " + goal_name(last_goal()) +
               " is not served before t = " + seconds(end));
  }

  void report_missing(std::size_t goal) {
    const double after = served_.empty() ? 0.0 : served_.back().ends;
    const Rest* nearest = nullptr;
    for (const Rest& rest : rests_) {
      if (rest.t_end < after - tolerance_.seconds) continue;
      if (is_in_pose(rest.pose, goal)) {
        const Goal& required = robot_.goal_at(goal);
        const double end = std::max({rest.t_begin, after, required.not_before}) + required.service;
        report(rest.t_end, rest.t_end, end,
               "the robot leaves " + goal_name(goal) + " at t = " + seconds(rest.t_end) +
                   ", but its service there ends at t = " + seconds(end));
        return;
      }
      if (nearest == nullptr || distance(rest.pose, goal) < distance(nearest->pose, goal)) nearest = &rest;
    }
    const double off = nearest == nullptr ? 0.0 : distance(nearest->pose, goal);
    const bool turned = nearest != nullptr && off <= tolerance_.metres;
    report(nearest == nullptr ? after : nearest->t_begin, off, 0.0,
           goal_name(goal) + " is not visited in its order: " +
               (turned ? "the robot rests there with another heading only"
                       : "the robot rests no nearer to it than " + metres(off)));
  }

  void check_claims() {
    if (plan_.visits.empty()) return;
    const std::size_t least = goals_left_ == GoalsLeft::allowed ? 0 : robot_.own_goal_count();
    const bool fewer = plan_.visits.size() >= least && plan_.visits.size() < robot_.goal_count();
    if (plan_.visits.size() != robot_.goal_count() && !fewer) {
      report(0.0, static_cast<double>(plan_.visits.size()), static_cast<double>(robot_.own_goal_count()),
             "the plan lists " + std::to_string(plan_.visits.size()) + " visits, but the robot has " +
                 std::to_string(robot_.own_goal_count()) + " goals");
      return;
    }
    double earliest = 0.0;
    for (std::size_t k = 0; k < plan_.visits.size(); ++k) {
      if (stop_.met()) return;
      const Visit& visit = plan_.visits[k];
      if (const auto wrong = wrong_claim(visit, k, earliest)) {
        report(usable_time(visit.t_arrive), usable_time(visit.t_arrive), earliest,
               "visits[" + std::to_string(k) + "] " + *wrong);
        return;
      }
      earliest = visit.t_leave;
    }
  }

  static double usable_time(double t) { return std::isfinite(t) ? t : 0.0; }

  std::optional<std::string> wrong_claim(const Visit& visit, std::size_t k, double earliest) const {
    const bool last = k == last_goal();
    if (visit.goal != k) return "is not to " + goal_name(k) + ", but goals are visited in their order";
    const bool numbers = std::isfinite(visit.t_arrive) && (last || std::isfinite(visit.t_leave));
    if (!numbers) return "has a time that is not finite";
    if (visit.t_arrive < earliest - tolerance_.seconds) return "begins before the one before it ends";
    const Goal& goal = robot_.goal_at(k);
    const double served = std::max(visit.t_arrive, goal.not_before) + goal.service;
    if (!last && visit.t_leave < served - tolerance_.seconds) {
      return "ends at t = " + seconds(visit.t_leave) + ", before the service does at t = " + seconds(served);
    }
    if (!rests_in(k, visit.t_arrive, last ? served : visit.t_leave, last)) {
      return "does not take place: the robot does not rest in the pose of " + goal_name(k) +
             " from t = " + seconds(visit.t_arrive) + " to its end";
    }
    return std::nullopt;
  }

  /// Whether one rest in the goal's pose contains this time; for the last goal, the last rest.
  bool rests_in(std::size_t goal, double from, double to, bool for_ever) const {
    const double slack = tolerance_.seconds;
    const auto contains = [&](const Rest& rest) {
      return rest.t_begin <= from + slack && to <= rest.t_end + slack && is_in_pose(rest.pose, goal);
    };
    if (for_ever) return contains(rests_.back());
    const auto first = std::lower_bound(rests_.begin(), rests_.end(), from - slack,
                                        [](const Rest& rest, double t) { return rest.t_end < t; });
    for (auto rest = first; rest != rests_.end() && rest->t_begin <= from + slack; ++rest) {
      if (contains(*rest)) return true;
    }
    return false;
  }

  /// Checks the goals that waits name. Waits that are committed come from the request and are not checked.
  void check_labels() {
    StopStride stride = StopStride::from_first(stop_, kRestsBetweenPolls);
    for (std::size_t k = robot_.committed.size(); k < plan_.actions.size(); ++k) {
      if (stride.met_at_step()) return;
      const Action& action = plan_.actions[k];
      if (!action.goal || is_true(action)) continue;
      report(action.t_start, static_cast<double>(*action.goal), 0.0,
             "actions[" + std::to_string(k) + "] has the goal " + std::to_string(*action.goal) +
                 ", but does not serve it");
      return;
    }
  }

  bool is_true(const Action& action) const {
    const std::size_t goal = *action.goal;
    if (action.type != Action::Type::wait || goal >= robot_.goal_count()) return false;
    if (!is_in_pose(action.from, goal)) return false;
    const auto meets = [&](double from, double to) {
      return action.t_start <= to + tolerance_.seconds && from <= action.t_end + tolerance_.seconds;
    };
    const bool claimed =
        goal < plan_.visits.size() && meets(plan_.visits[goal].t_arrive, plan_.visits[goal].t_leave);
    return claimed || (goal < served_.size() && meets(served_[goal].arrives, served_[goal].ends));
  }

  void report(double t, double found, double required, const std::string& detail) {
    violations_.push_back({.kind = Violation::Kind::wrong_visit,
                           .robots = {plan_.robot},
                           .t = t,
                           .distance = found,
                           .required = required,
                           .detail = detail});
  }

  const Robot& robot_;
  const RobotPlan& plan_;
  Tolerance tolerance_;
  const GoalsLeft goals_left_;
  const StopCondition& stop_;
  std::vector<Rest> rests_;
  std::vector<Service> served_;  // by goal, as early as possible
  std::vector<Violation> violations_;
};

}  // namespace

std::vector<Violation> check_visits(const Robot& robot, const RobotPlan& plan, const Tolerance& tolerance,
                                    GoalsLeft goals_left, const StopCondition& stop) {
  return VisitCheck(robot, plan, tolerance, goals_left, stop).run();
}

std::size_t goals_served_by_commitment(const Robot& robot, const Tolerance& tolerance,
                                       const StopCondition& stop) {
  if (!robot.goal || robot.committed.empty()) return 0;
  const RobotPlan committed{0, robot.committed_until(), robot.committed};
  return VisitCheck(robot, committed, tolerance, GoalsLeft::allowed, stop).count_served();
}

}  // namespace fleetplan::core
