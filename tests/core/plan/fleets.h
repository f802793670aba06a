#pragma once

// Fleets with previous plans.

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/plan/planner.h"
#include "tests/support/problem_builder.h"
#include "tests/support/random_problem.h"

namespace fleetplan::core {

/// `count` robots of radius 0.4 m with goals on an empty map of 20 m x 20 m.
inline Problem crowd(std::size_t count, std::uint64_t seed) {
  support::Dice dice(seed);
  const OccupancyGrid grid(20, 20, 1.0);
  std::vector<Position> starts;
  std::vector<Position> goals;
  const auto free_place = [&](const std::vector<Position>& taken) {
    while (true) {
      const Position p = grid.center({dice.below(20), dice.below(20)});
      bool is_free = true;
      for (const Position& other : taken) is_free = is_free && (p - other).norm() > 0.5;
      if (is_free) return p;
    }
  };
  std::vector<Robot> robots;
  for (std::size_t i = 0; i < count; ++i) {
    starts.push_back(free_place(starts));
    goals.push_back(free_place(goals));
    robots.push_back(support::robot_at(starts[i].x(), starts[i].y()).to(goals[i].x(), goals[i].y()));
  }
  return support::make_problem(grid, std::move(robots));
}

/// The robots of the problem with the plans as their previous ones.
inline std::vector<Robot> with_previous(const Problem& problem, const Plan& plan) {
  std::vector<Robot> robots = problem.robots();
  for (const RobotPlan& robot : plan.plans) robots[robot.robot].previous = robot.actions;
  return robots;
}

/// The actions after a wait of so many seconds.
inline std::vector<Action> delayed(const Robot& robot, std::vector<Action> actions, double seconds) {
  for (Action& action : actions) {
    action.t_start += seconds;
    action.t_end += seconds;
  }
  actions.insert(actions.begin(), Action{Action::Type::wait, 0.0, seconds, robot.start, robot.start});
  return actions;
}

inline bool same_actions(const std::vector<Action>& a, const std::vector<Action>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Action& x, const Action& y) {
    return x.type == y.type && x.t_start == y.t_start && x.t_end == y.t_end && x.goal == y.goal &&
           x.from.position == y.from.position && x.from.theta == y.from.theta &&
           x.to.position == y.to.position && x.to.theta == y.to.theta;
  });
}

/// The number of robots that follow their previous plans to the last digit.
inline std::size_t count_followed(const Problem& problem, const Plan& plan) {
  std::size_t count = 0;
  for (const RobotPlan& robot : plan.plans) {
    const auto& previous = problem.robots()[robot.robot].previous;
    if (previous && same_actions(robot.actions, *previous)) ++count;
  }
  return count;
}

}  // namespace fleetplan::core
