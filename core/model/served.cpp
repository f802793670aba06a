#include "core/model/served.h"

#include <algorithm>
#include <utility>

#include "core/geometry/position.h"
#include "core/geometry/segment.h"
#include "core/geometry/tolerance.h"

namespace fleetplan::core {

bool is_in_pose(const Pose& pose, const Goal& goal) {
  if (goal.anywhere) return true;
  return (pose.position - goal.position).norm() <= kContactTolerance &&
         (!goal.theta || angle_between(pose.theta, *goal.theta) <= kContactTolerance);
}

GoalsOnTheWay::GoalsOnTheWay(const Robot& robot) : robot_(robot) { rest(robot.start); }

void GoalsOnTheWay::execute(const Action& action) {
  if (action.type != Action::Type::wait) arrived_ = action.t_end;
  now_ = action.t_end;
  rest(action.to);
}

/// Serves the goals in this pose, in which the robot is at rest from `arrived_` to `now_`.
void GoalsOnTheWay::rest(const Pose& pose) {
  service_done_ = 0.0;
  for (; count() < robot_.goal_count() && is_in_pose(pose, robot_.goal_at(count()));) {
    const Goal& goal = robot_.goal_at(count());
    const double begin = std::max(arrived_, goal.not_before);
    service_done_ = std::clamp(now_ - begin, 0.0, goal.service);
    if (count() + 1 == robot_.goal_count() || begin + goal.service > now_ + kSameTime) return;
    visits_.push_back({count(), arrived_, begin + goal.service});
    arrived_ = begin + goal.service;
    service_done_ = 0.0;
  }
}

ServedGoals served_goals(const Robot& robot, std::span<const Action> actions) {
  GoalsOnTheWay on_the_way(robot);
  for (const Action& action : actions) on_the_way.execute(action);
  ServedGoals served{on_the_way.visits()};
  const Pose pose = actions.empty() ? robot.start : actions.back().to;
  if (robot.goal && is_in_pose(pose, robot.goal_at(on_the_way.count()))) {
    served.in_next_pose = true;
    served.arrived = on_the_way.arrived();
    served.service_done = on_the_way.service_done();
  }
  return served;
}

std::vector<Visit> visits_of(const Robot& robot, std::span<const Action> actions) {
  ServedGoals served = served_goals(robot, actions);
  const std::size_t last = robot.goal_count() - 1;
  if (robot.goal && served.in_next_pose && served.visits.size() == last) {
    served.visits.push_back({last, served.arrived, kForever});
  }
  return std::move(served.visits);
}

namespace {

/// The time in which a robot rests for a goal.
struct Service {
  std::size_t goal;
  double begin;
  double end;
};

/// The services that take time, in their order. A service that goes on at the end of the actions has no end.
std::vector<Service> services_of(const Robot& robot, std::span<const Action> actions) {
  std::vector<Service> services;
  const auto add = [&](std::size_t index, double arrived, double end) {
    const Goal& goal = robot.goal_at(index);
    if (goal.service > 0.0 || goal.not_before > 0.0) services.push_back({index, arrived, end});
  };
  const ServedGoals served = served_goals(robot, actions);
  for (const Visit& visit : served.visits) add(visit.goal, visit.t_arrive, visit.t_leave);
  const std::size_t next = served.visits.size();
  if (served.in_next_pose) add(next, served.arrived, robot.goal_at(next).service_end(served.arrived));
  return services;
}

/// Adds a wait in parts, of which each serves one goal or none.
void add_parts(const Action& wait, std::span<const Service> services, std::vector<Action>& parts) {
  Action part = wait;
  part.goal.reset();
  for (const Service& service : services) {
    if (service.begin > part.t_start + kLeastAction) {
      part.t_end = service.begin;
      parts.push_back(part);
      part.t_start = part.t_end;
    }
    part.t_end = service.end < wait.t_end - kLeastAction ? service.end : wait.t_end;
    part.goal = service.goal;
    parts.push_back(part);
    part.t_start = part.t_end;
    part.goal.reset();
  }
  part.t_end = wait.t_end;
  if (services.empty() || part.t_end > part.t_start) parts.push_back(part);
}

}  // namespace

void mark_services(const Robot& robot, std::vector<Action>& actions, std::size_t first) {
  if (!robot.goal) return;
  const std::vector<Service> services = services_of(robot, actions);
  std::vector<Action> marked;
  marked.reserve(actions.size());
  auto next = services.begin();
  // Bounded: services follow one another, and so do actions. Each action looks only at the services of its
  // own time.
  for (std::size_t k = 0; k < actions.size(); ++k) {
    Action action = actions[k];
    const double shortest = std::min(kLeastAction, 0.5 * (action.t_end - action.t_start));
    while (next != services.end() && next->end <= action.t_start + shortest) ++next;
    auto last = next;
    while (last != services.end() && last->begin < action.t_end - shortest) ++last;
    if (action.type != Action::Type::wait) {
      marked.push_back(action);
    } else if (k >= first) {
      add_parts(action, std::span(next, last), marked);
    } else {
      action.goal = next != last ? std::optional(next->goal) : std::nullopt;
      marked.push_back(action);
    }
  }
  actions = std::move(marked);
}

const std::vector<Action>& previous_actions(const Robot& robot) {
  return robot.goal && robot.previous && !robot.previous->empty() ? *robot.previous : robot.committed;
}

double last_service_end(const Robot& robot, std::span<const Action> actions) {
  const std::vector<Visit> visits = visits_of(robot, actions);
  if (visits.size() < robot.goal_count()) return kForever;
  return std::max(robot.goal->service_end(visits.back().t_arrive), robot.committed_until());
}

double previous_service_end(const Robot& robot) { return last_service_end(robot, previous_actions(robot)); }

}  // namespace fleetplan::core
