#include "core/model/itinerary.h"

#include <utility>

#include "core/model/served_goals.h"

namespace fleetplan::core {
namespace {

Trajectory committed_trajectory(const Robot& robot) {
  Trajectory trajectory;
  trajectory.start = robot.start.position;
  for (const Action& action : robot.committed) {
    if (action.type != Action::Type::translate || action.from.position == action.to.position) continue;
    trajectory.moves.push_back({{action.from.position, action.to.position}, action.t_start, action.t_end});
  }
  trajectory.cost = robot.committed_until();
  return trajectory;
}

}  // namespace

Itinerary itinerary_of(const Robot& robot) {
  Itinerary itinerary;
  itinerary.committed = committed_trajectory(robot);
  itinerary.pose = robot.committed_end();
  itinerary.t_begin = robot.committed_until();
  if (!robot.committed.empty()) {
    ServedGoals served = served_goals(robot, robot.committed);
    itinerary.visited = std::move(served.visits);
    itinerary.first_goal = itinerary.visited.size();
    itinerary.arrived = served.arrived;
    itinerary.service_done = served.service_done;
  }
  for (std::size_t k = itinerary.first_goal; k < robot.goal_count(); ++k) {
    itinerary.goals.push_back(robot.goal_at(k));
  }
  return itinerary;
}

}  // namespace fleetplan::core
