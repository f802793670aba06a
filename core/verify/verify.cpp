#include "core/verify/verify.h"

#include <cmath>
#include <stdexcept>
#include <utility>

#include "core/verify/execution/execution.h"
#include "core/verify/pairs/fleet_clearance.h"
#include "core/verify/quantity_text.h"
#include "core/verify/rules/endpoint_rules.h"
#include "core/verify/rules/motion_rules.h"
#include "core/verify/rules/obstacle_rules.h"
#include "core/verify/violation_list.h"

namespace fleetplan::core {
namespace {

/// The plan of each robot, null where it has none.
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

Violation collision(const Overlap& overlap, const std::vector<std::size_t>& robots,
                    const std::vector<double>& radii) {
  const double contact = radii[overlap.first] + radii[overlap.second];
  std::string detail = "the disks overlap by " + metres(contact - overlap.distance) +
                       " from t = " + seconds(overlap.t_begin) +
                       (std::isfinite(overlap.t_end) ? " to " + seconds(overlap.t_end) : " on, for ever");
  return {Violation::Kind::robot_collision,
          {robots[overlap.first], robots[overlap.second]},
          overlap.t_deepest,
          overlap.distance,
          contact,
          std::move(detail),
          {}};
}

}  // namespace

VerifyReport verify(const OccupancyGrid& grid, const std::vector<Robot>& robots,
                    const std::vector<RobotPlan>& plans, double tolerance) {
  return *verify(grid, robots, plans, tolerance, StopCondition());
}

std::optional<VerifyReport> verify(const OccupancyGrid& grid, const std::vector<Robot>& robots,
                                   const std::vector<RobotPlan>& plans, double tolerance,
                                   const StopCondition& stop) {
  return verify(grid, robots, plans, std::vector(robots.size(), Tolerance::of_all(tolerance)), stop);
}

std::optional<VerifyReport> verify(const OccupancyGrid& grid, const std::vector<Robot>& robots,
                                   const std::vector<RobotPlan>& plans,
                                   const std::vector<Tolerance>& tolerances, const StopCondition& stop) {
  const std::vector<MovingObstacle> none;
  CheckRules rules;
  rules.tolerances = tolerances;
  return verify({grid, robots, none}, plans, rules, stop);
}

std::optional<VerifyReport> verify(const CheckedFleet& fleet, const std::vector<RobotPlan>& plans,
                                   const CheckRules& rules, const StopCondition& stop) {
  const std::vector<Robot>& robots = fleet.robots;
  const std::vector<Tolerance>& tolerances = rules.tolerances;
  ViolationList violations;
  const ObstacleField field(fleet.grid);
  const std::vector<const RobotPlan*> plan_of = plans_by_robot(robots.size(), plans);
  std::vector<std::size_t> checked;  // the robots whose numbers are usable
  std::vector<double> radii;
  std::vector<double> overlaps;  // metres, the tolerances
  std::vector<std::vector<Leg>> legs;
  for (std::size_t index = 0; index < robots.size(); ++index) {
    if (stop.met()) return std::nullopt;
    const Robot& robot = robots[index];
    const RobotPlan* plan = plan_of[index];
    if (const auto unusable = find_unusable_number(index, robot, plan)) {
      violations.add(*unusable);
      continue;
    }
    if (plan != nullptr) {
      violations.add(check_motion(robot, *plan, tolerances[index], stop));
      for (Violation& wrong : check_endpoints(robot, *plan, tolerances[index]))
        violations.add(std::move(wrong));
    }
    checked.push_back(index);
    radii.push_back(robot.radius);
    overlaps.push_back(tolerances[index].metres);
    legs.push_back(execute(robot, plan));
    violations.add(check_obstacles(field, index, robot.radius, legs.back(), overlaps.back(), stop));
  }

  const auto clearance = fleet_clearance(legs, radii, overlaps, kMostCollisions, stop);
  if (!clearance || stop.met()) return std::nullopt;
  for (const Overlap& overlap : clearance->overlaps) {
    violations.add(collision(overlap, checked, radii));
  }
  const std::size_t count = violations.total();
  return VerifyReport{violations.take(), count, clearance->least};
}

}  // namespace fleetplan::core
