#include "core/replan/previous_plan.h"

#include <algorithm>
#include <utility>

#include "core/geometry/segment.h"
#include "core/model/itinerary.h"
#include "core/model/radius_steps.h"
#include "core/model/served_goals.h"

namespace fleetplan::core {
namespace {

/// The itinerary of the robot if all its previous actions were committed.
Itinerary as_committed(const Robot& robot) {
  Robot follower = robot;
  follower.committed = previous_actions(robot);
  return itinerary_of(follower);
}

/// When the service at the last goal ends; none that is committed ends before the commitment does.
double last_service_end(const Robot& robot) {
  const std::vector<Visit> visits = visits_of(robot, previous_actions(robot));
  if (visits.size() < robot.goal_count()) return kForever;
  const double end = std::max(visits.back().t_arrive, robot.goal->not_before) + robot.goal->service;
  return std::max(end, robot.committed_until());
}

}  // namespace

bool have_previous_plans(const std::vector<Robot>& robots) {
  return std::any_of(robots.begin(), robots.end(),
                     [](const Robot& robot) { return robot.previous.has_value(); });
}

const std::vector<Action>& previous_actions(const Robot& robot) {
  return robot.goal && robot.previous && !robot.previous->empty() ? *robot.previous : robot.committed;
}

RobotPlan previous_plan(std::size_t index, const Robot& robot) {
  const std::vector<Action>& actions = previous_actions(robot);
  return {index, actions.empty() ? 0.0 : actions.back().t_end, actions, 0.0};
}

Trajectory previous_trajectory(const Robot& robot) {
  Itinerary all = as_committed(robot);
  Trajectory trajectory = std::move(all.committed);
  const std::size_t first = itinerary_of(robot).first_goal;
  for (const Visit& visit : all.visited) {
    if (visit.goal >= first) trajectory.visits.push_back(visit);
  }
  if (robot.goal && changes_radius(robot)) trajectory.last_served = last_service_end(robot);
  trajectory.is_previous = true;
  return trajectory;
}

}  // namespace fleetplan::core
