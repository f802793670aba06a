#pragma once

// A fleet at a later moment of its plans, in the simplest way.

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "core/geometry/position.h"
#include "core/model/itinerary.h"
#include "core/model/loads.h"
#include "core/model/plan.h"
#include "core/model/problem.h"

namespace fleetplan::support {

/// Returns the pose within an action at time `t`.
inline core::Pose pose_within(const core::Action& action, double t) {
  if (t >= action.t_end) return action.to;
  const double part = (t - action.t_start) / (action.t_end - action.t_start);
  const double turn = core::rotation_between(action.from.theta, action.to.theta);
  return {action.from.position + part * (action.to.position - action.from.position),
          core::normalize_angle(action.from.theta + part * turn)};
}

/// Returns the part of the actions before `t`; the one under way is cut there.
inline std::vector<core::Action> actions_before(const std::vector<core::Action>& actions, double t) {
  std::vector<core::Action> part;
  for (const core::Action& action : actions) {
    if (action.t_start >= t) break;
    part.push_back(action);
    if (action.t_end <= t) continue;
    part.back().to = pose_within(action, t);
    part.back().t_end = t;
  }
  return part;
}

/// Returns the part of the actions after `t`, with times from `t` on.
inline std::vector<core::Action> actions_after(const std::vector<core::Action>& actions, double t) {
  std::vector<core::Action> part;
  for (core::Action action : actions) {
    if (action.t_end <= t) continue;
    if (action.t_start < t) {
      action.from = pose_within(action, t);
      action.t_start = t;
    }
    action.t_start -= t;
    action.t_end -= t;
    part.push_back(action);
  }
  return part;
}

/// Returns the actions `by` seconds later.
inline std::vector<core::Action> later(std::vector<core::Action> actions, double by) {
  for (core::Action& action : actions) {
    action.t_start += by;
    action.t_end += by;
  }
  return actions;
}

/// Leaves out the goals that are visited by `t`, and the part of a service that is done.
inline void leave_visited_goals(core::Robot& robot, const core::RobotPlan& plan, double t) {
  std::vector<core::Goal> goals(robot.via);
  goals.push_back(*robot.goal);
  std::size_t first = 0;
  for (std::size_t k = 0; k < plan.visits.size(); ++k) {
    const core::Visit& visit = plan.visits[k];
    const double begin = std::max(visit.t_arrive, goals[k].not_before);
    const bool last = k + 1 == goals.size();  // a plan that stops at the horizon has fewer visits
    if (visit.t_arrive > t) break;
    const double done = std::clamp(t - begin, 0.0, goals[k].service);
    if (!last && visit.t_leave <= t) {
      first = k + 1;
    } else {
      goals[k].service -= done;
      break;
    }
  }
  for (std::size_t k = 0; k < first; ++k) {
    core::set_load(robot, core::load_after(core::first_load(robot), goals[k]));
  }
  if (plan.visits.size() == goals.size() && first + 1 == goals.size()) {
    core::Goal& last = goals.back();
    const double begin = std::max(plan.visits.back().t_arrive, last.not_before);
    if (last.radius_after && last.service == 0.0 && begin <= t && plan.visits.back().t_arrive <= t) {
      robot.radius = *std::exchange(last.radius_after, std::nullopt);
    }
  }
  for (core::Goal& goal : goals) goal.not_before = std::max(0.0, goal.not_before - t);
  robot.goal = goals.back();
  robot.via.assign(goals.begin() + static_cast<std::ptrdiff_t>(first), goals.end() - 1);
  const auto renumber = [first](std::vector<core::Action>& actions) {
    for (core::Action& action : actions) {
      if (!action.goal) continue;
      action.goal = *action.goal >= first ? std::optional(*action.goal - first) : std::nullopt;
    }
  };
  renumber(robot.committed);
  if (robot.previous) renumber(*robot.previous);
}

/// Returns the robot at `t` of its plan, committed to what it does in the next `commit` seconds. What follows
/// is its previous plan.
inline core::Robot robot_at_moment(core::Robot robot, const core::RobotPlan& plan, double t, double commit) {
  const std::vector<core::Action> rest = actions_after(plan.actions, t);
  if (!plan.actions.empty()) robot.start = rest.empty() ? plan.actions.back().to : rest.front().from;
  robot.committed = actions_before(rest, commit);
  robot.previous = robot.committed;
  for (const core::Action& action : later(actions_after(rest, commit), commit)) {
    robot.previous->push_back(action);
    // The times of both parts are the same numbers.
    core::Action& last = robot.previous->back();
    if (robot.previous->size() > 1) last.t_start = (robot.previous->end() - 2)->t_end;
  }
  if (robot.goal) leave_visited_goals(robot, plan, t);
  return robot;
}

/// Leaves out the goals that the robot's commitment has served by `t`; the robot has the load after them.
inline void leave_goals_served(core::Robot& robot, double t) {
  core::Robot past = robot;
  past.committed = actions_before(robot.committed, t);
  const std::size_t served = core::itinerary_of(past).first_goal;
  core::set_load(robot, core::loads_of(robot)[served]);
  robot.via.erase(robot.via.begin(), robot.via.begin() + static_cast<std::ptrdiff_t>(served));
}

/// Returns a robot without a plan at `t` of its commitment.
inline core::Robot robot_at_moment(core::Robot robot, double t) {
  const std::vector<core::Action> given = robot.committed;
  const std::vector<core::Action> rest = actions_after(given, t);
  const core::Pose end = robot.committed_end();
  if (core::changes_load(robot)) leave_goals_served(robot, t);
  robot.start = rest.empty() ? end : rest.front().from;
  robot.committed = rest;
  robot.previous.reset();
  if (!robot.goal) return robot;
  for (core::Goal& goal : robot.via) goal.not_before = std::max(0.0, goal.not_before - t);
  robot.goal->not_before = std::max(0.0, robot.goal->not_before - t);
  return robot;
}

/// Returns the obstacle at `t`; nullopt if it has left.
inline std::optional<core::MovingObstacle> obstacle_at_moment(const core::MovingObstacle& obstacle,
                                                              double t) {
  using Entry = core::MovingObstacle::Entry;
  core::MovingObstacle left = obstacle;
  left.motion.clear();
  for (std::size_t k = 0; k < obstacle.motion.size(); ++k) {
    const Entry& entry = obstacle.motion[k];
    if (entry.t >= t) {
      left.motion.push_back({entry.t - t, entry.position});
    } else if (k + 1 < obstacle.motion.size() && obstacle.motion[k + 1].t > t) {
      const Entry& next = obstacle.motion[k + 1];
      const double part = (t - entry.t) / (next.t - entry.t);
      left.motion.push_back({0.0, entry.position + part * (next.position - entry.position)});
    } else if (k + 1 == obstacle.motion.size() && obstacle.after == core::MovingObstacle::After::stays) {
      left.motion.push_back({0.0, entry.position});
    }
  }
  if (left.motion.empty()) return std::nullopt;
  return left;
}

}  // namespace fleetplan::support
