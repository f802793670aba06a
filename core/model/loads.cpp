#include "core/model/loads.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "core/geometry/tolerance.h"
#include "core/model/trajectory.h"

namespace fleetplan::core {
namespace {

template <class Condition>
bool any_goal(const Robot& robot, const Condition& condition) {
  return (robot.goal && condition(*robot.goal)) || std::any_of(robot.via.begin(), robot.via.end(), condition);
}

}  // namespace

Load first_load(const Robot& robot) {
  return {robot.radius, robot.linear_speed, robot.linear_acceleration, robot.linear_deceleration};
}

Load load_after(const Load& before, const Goal& goal) {
  return {goal.radius_after.value_or(before.radius), goal.linear_speed_after.value_or(before.linear_speed),
          goal.linear_acceleration_after.value_or(before.linear_acceleration),
          goal.linear_deceleration_after.value_or(
              goal.linear_acceleration_after.value_or(before.linear_deceleration))};
}

std::vector<Load> loads_of(const Robot& robot) {
  std::vector<Load> loads{first_load(robot)};
  loads.reserve(robot.goal_count() + 1);
  for (std::size_t k = 0; k < robot.goal_count(); ++k) {
    loads.push_back(load_after(loads.back(), robot.goal_at(k)));
  }
  return loads;
}

Load load_during(const Robot& robot, std::span<const Action> actions, std::size_t index) {
  if (!changes_load(robot)) return first_load(robot);
  LoadOnTheWay on_the_way(robot);
  for (const Action& action : actions.first(index)) on_the_way.execute(action);
  return on_the_way.load();
}

namespace {

bool can_execute(const Robot& robot, const Load& load, Action action) {
  if (action.type != Action::Type::translate) return true;
  const double duration = action.t_end - action.t_start;
  if (amount_of(action) > load.linear_speed * duration + kContactTolerance) return false;
  if (!action.profile) return true;
  set_inertia(action, robot, load);
  return action.profile->cruise <= load.linear_speed + kContactTolerance && profile_fits(action);
}

}  // namespace

std::size_t count_of_executable(const Robot& robot, std::span<const Action> actions) {
  if (!changes_load(robot)) return actions.size();
  const Load first = first_load(robot);
  LoadOnTheWay on_the_way(robot);
  for (std::size_t k = 0; k < actions.size(); ++k) {
    const Load& load = on_the_way.load();
    if (load != first && !can_execute(robot, load, actions[k])) return k;
    on_the_way.execute(actions[k]);
  }
  return actions.size();
}

void set_load(Robot& robot, const Load& load) {
  robot.radius = load.radius;
  robot.linear_speed = load.linear_speed;
  robot.linear_acceleration = load.linear_acceleration;
  robot.linear_deceleration = load.linear_deceleration;
}

bool changes_load(const Robot& robot) {
  const Load first = first_load(robot);
  return any_goal(robot, [&](const Goal& goal) { return load_after(first, goal) != first; });
}

void set_inertia(Action& action, const Robot& robot, const Load& load) {
  if (!action.profile) return;
  action.profile->inertia =
      action.type == Action::Type::rotate ? robot.angular_inertia() : load.linear_inertia();
}

void set_inertia(std::vector<Action>& actions, const Robot& robot) {
  if (!changes_load(robot)) {
    for (Action& action : actions) set_inertia(action, robot, first_load(robot));
    return;
  }
  LoadOnTheWay on_the_way(robot);
  for (Action& action : actions) {
    set_inertia(action, robot, on_the_way.load());
    on_the_way.execute(action);
  }
}

std::vector<double> radii_of(const Robot& robot) {
  std::vector<double> radii;
  for (const Load& load : loads_of(robot)) radii.push_back(load.radius);
  return radii;
}

bool changes_radius(const Robot& robot) {
  return any_goal(robot,
                  [&](const Goal& goal) { return goal.radius_after.value_or(robot.radius) != robot.radius; });
}

double largest_radius(const Robot& robot) {
  double largest = robot.radius;
  for (std::size_t k = 0; k < robot.goal_count(); ++k) {
    largest = std::max(largest, robot.goal_at(k).radius_after.value_or(largest));
  }
  return largest;
}

double last_radius(const Robot& robot) {
  for (std::size_t k = robot.goal_count(); k > 0; --k) {
    if (const auto& radius = robot.goal_at(k - 1).radius_after) return *radius;
  }
  return robot.radius;
}

}  // namespace fleetplan::core
