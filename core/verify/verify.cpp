#include "core/verify/verify.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "core/geometry/angle.h"
#include "core/geometry/tolerance.h"
#include "core/verify/execution.h"
#include "core/verify/pairs/check_pairs.h"
#include "core/verify/rules/robot_rules.h"

namespace fleetplan::core {
namespace {

/// Returns the plan of each robot, null where it has none.
std::vector<const RobotPlan*> plans_by_robot(std::size_t robots, const std::vector<RobotPlan>& plans) {
  std::vector<const RobotPlan*> by_robot(robots, nullptr);
  for (const RobotPlan& plan : plans) {
    if (plan.robot >= robots || by_robot[plan.robot] != nullptr) {
      throw std::invalid_argument("a plan of no robot, or a second one of the same robot");
    }
    by_robot[plan.robot] = &plan;
  }
  return by_robot;
}

/// Checks each robot alone, and then all of them together.
class FleetCheck {
 public:
  FleetCheck(const CheckedFleet& fleet, const std::vector<RobotPlan>& plans, const CheckRules& rules,
             const StopCondition& stop)
      : request_(fleet), rules_(rules), stop_(stop), plan_of_(plans_by_robot(fleet.robots.size(), plans)) {}

  std::optional<VerifyReport> run() {
    const ObstacleField field(request_.grid);
    for (std::size_t index = 0; index < request_.robots.size(); ++index) {
      if (stop_.met()) return std::nullopt;
      check_alone(index, field);
    }
    std::optional<PairReport> pairs = check_pairs(fleet_, request_.obstacles, rules_, stop_);
    if (!pairs || stop_.met()) return std::nullopt;
    violations_.add(std::move(pairs->violations));
    const std::size_t count = violations_.total();
    return VerifyReport{violations_.take(), count, pairs->min_clearance};
  }

 private:
  void check_alone(std::size_t index, const ObstacleField& field) {
    const RobotPlan* plan = plan_of_[index];
    if (const auto unusable = find_unusable_number(index, request_.robots[index], plan)) {
      violations_.add(*unusable);
      return;
    }
    const Tolerance& tolerance = rules_.tolerances[index];
    const ZonesOfRobot zones(request_.zones, index);
    if (const auto less = without_goals_put_off(request_.robots[index], plan, zones, tolerance)) {
      check_alone(index, less->robot, plan != nullptr ? &less->plan : nullptr, field, zones);
    } else {
      check_alone(index, request_.robots[index], plan, field, zones);
    }
  }

  /// A robot some of whose goals are put off, see Zone::may_leave: it visits those before them and may rest
  /// where its plan ends.
  struct PutOff {
    Robot robot;
    RobotPlan plan;
  };

  /// Whether a plan is to visit this goal of the robot: by its list of visits or, without one, as it ends at
  /// the last goal.
  static bool serves(const Robot& robot, const RobotPlan& plan, std::size_t goal,
                     const Tolerance& tolerance) {
    if (!plan.visits.empty()) return goal < plan.visits.size();
    const Pose& end = plan.actions.empty() ? robot.start : plan.actions.back().to;
    const Goal& last = robot.goal_at(robot.own_goal_count() - 1);
    const double metres = std::max(tolerance.metres, kContactTolerance);
    return (end.position - last.position).norm() <= metres &&
           (!last.theta || angle_between(end.theta, *last.theta) <= tolerance.radians);
  }

  std::optional<PutOff> without_goals_put_off(const Robot& robot, const RobotPlan* plan,
                                              const ZonesOfRobot& zones, const Tolerance& tolerance) const {
    if (!zones.may_leave_any()) return std::nullopt;
    const std::size_t first = goals_served_by_commitment(robot, tolerance, stop_);
    const double margin = std::max(tolerance.metres, kContactTolerance);
    const auto visits = [&](std::size_t goal) {
      return plan != nullptr && serves(robot, *plan, goal, tolerance);
    };
    const auto put_off = zones.first_goal_put_off(robot, first, margin, visits);
    if (!put_off) return std::nullopt;
    PutOff less{robot, plan != nullptr ? *plan : RobotPlan{}};
    less.robot.via.resize(*put_off);
    const bool moves = less.plan.actions.size() > robot.committed.size();
    const bool stays = *put_off == 0 && !moves && !robot.yields();  // as if it had no goal
    const Pose end = less.plan.actions.empty() ? robot.committed_end() : less.plan.actions.back().to;
    less.robot.goal = stays ? std::nullopt : std::optional(Goal{end.position, std::nullopt});
    less.plan.visits.resize(std::min(less.plan.visits.size(), *put_off));
    const bool visits_all_before = *put_off > 0 && less.plan.visits.size() == *put_off;
    if (visits_all_before) less.plan.visits.push_back({*put_off, plan->cost, kForever});
    return less;
  }

  void check_alone(std::size_t index, const Robot& robot, const RobotPlan* plan, const ObstacleField& field,
                   const ZonesOfRobot& zones) {
    const Tolerance& tolerance = rules_.tolerances[index];
    const CarriedLoads loads(robot, plan, tolerance);
    if (plan != nullptr) check_plan(robot, *plan, loads, tolerance);
    const Departure departure = departure_of(robot, plan);
    std::vector<Leg> legs;
    std::vector<double> radii;  // by leg
    for (Body& body : bodies_of(loads, execute(robot, plan, loads))) {
      legs.insert(legs.end(), body.legs.begin(), body.legs.end());
      radii.resize(legs.size(), body.radius);
      add_to_fleet(robot, plan, std::move(body), departure, index);
    }
    if (robot.invalid) return;  // it may stand in a wall
    const auto distance_from = [&](const Position& position, double reach) {
      return zones.distance_to_blocked(position, distance_from_walls(field, position, reach));
    };
    const std::vector<double> kept =
        distances_to_keep(distance_from, radii, legs, departure, tolerance.metres, rules_);
    violations_.add(check_obstacles(field, index, kept, legs, tolerance.metres, stop_));
    if (zones.empty()) return;
    violations_.add(zones.check_blocked(kept, legs, departure, tolerance.metres, stop_));
    violations_.add(
        zones.check_driving(plan != nullptr ? plan->actions : robot.committed, loads, tolerance, stop_));
  }

  void add_to_fleet(const Robot& robot, const RobotPlan* plan, Body body, const Departure& departure,
                    std::size_t index) {
    fleet_.robots.push_back(index);
    fleet_.radii.push_back(body.radius);
    fleet_.vicinities.push_back(robot.vicinity);
    fleet_.tolerances.push_back(rules_.tolerances[index].metres);
    fleet_.legs.push_back(std::move(body.legs));
    fleet_.departures.push_back(departure);
    fleet_.invalid.push_back(robot.invalid);
    fleet_.stays.push_back(plan == nullptr || !robot.goal);
  }

  void check_plan(const Robot& robot, const RobotPlan& plan, const CarriedLoads& loads,
                  const Tolerance& tolerance) {
    const auto changed = check_commitments(robot, plan, tolerance, rules_.exact_commitments);
    if (changed) violations_.add(*changed);
    // Committed actions that repeat those of the request exactly are not judged.
    const std::size_t given = rules_.exact_commitments && !changed ? robot.committed.size() : 0;
    violations_.add(check_motion(robot, plan, given, loads, tolerance, stop_));
    const GoalsLeft goals_left =
        may_leave_goals(robot, plan, tolerance) ? GoalsLeft::allowed : GoalsLeft::none;
    for (Violation& wrong : check_endpoints(robot, plan, tolerance, goals_left))
      violations_.add(std::move(wrong));
    for (Violation& wrong : check_visits(robot, plan, tolerance, goals_left, stop_))
      violations_.add(std::move(wrong));
    violations_.add(check_waits(robot, plan, rules_.wait_before_move, tolerance, stop_));
  }

  bool may_leave_goals(const Robot& robot, const RobotPlan& plan, const Tolerance& tolerance) const {
    return rules_.horizon && robot.goal && !plan.actions.empty() &&
           plan.actions.back().t_end >= *rules_.horizon - tolerance.seconds;
  }

  const CheckedFleet& request_;
  const CheckRules& rules_;
  const StopCondition& stop_;
  std::vector<const RobotPlan*> plan_of_;
  ExecutedFleet fleet_;  // the robots whose numbers are usable
  ViolationList violations_;
};

}  // namespace

std::optional<VerifyReport> verify(const CheckedFleet& fleet, const std::vector<RobotPlan>& plans,
                                   const CheckRules& rules, const StopCondition& stop) {
  return FleetCheck(fleet, plans, rules, stop).run();
}

std::optional<VerifyReport> check_plan(const Problem& problem, const PlanOptions& options, const Plan& plan,
                                       const StopCondition& stop) {
  CheckRules rules{plan_tolerances(problem.grid(), problem.robots(), plan.plans)};
  rules.interval_margin = options.interval_margin;
  rules.start_overlap = options.start_overlap;
  rules.horizon = options.horizon;
  rules.exact_commitments = true;
  rules.exempt = plan.unavoidable;
  return verify({problem.grid(), problem.robots(), problem.obstacles(), &problem.zones()}, plan.plans, rules,
                stop);
}

}  // namespace fleetplan::core
