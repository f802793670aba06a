#include "core/model/open_goal.h"

#include <algorithm>
#include <optional>

#include "core/geometry/segment.h"
#include "core/model/itinerary.h"

namespace fleetplan::core {
namespace {

/// When a goal in its present pose has been served by the actions, seconds; kForever if it has not.
double served_at(const Robot& robot, const OpenGoal& open, std::span<const Action> actions, bool also_last) {
  const ServedGoals served = served_goals(robot, actions);
  if (served.visits.size() > open.goal) return served.visits[open.goal].t_leave;
  const bool is_there = served.in_next_pose && served.visits.size() == open.goal;
  return is_there && (also_last || served.service_done > 0.0) ? served.arrived : kForever;
}

}  // namespace

bool stays_at(const Robot& robot, std::size_t goal) {
  return !robot.yields() && goal + 1 == robot.goal_count();
}

void choose(Robot& robot, OpenGoal& open, std::size_t pose) {
  open.chosen = pose;
  Goal& goal = open.goal < robot.via.size() ? robot.via[open.goal] : *robot.goal;
  goal.position = open.choice().position;
  goal.theta = open.choice().theta;
  if (robot.yields() && open.goal + 1 == robot.via.size()) robot.goal->position = goal.position;
}

void settle_by_actions(Robot& robot, std::vector<OpenGoal>& open, std::span<const Action> actions,
                       bool also_last, const StopCondition& stop) {
  if (actions.empty() && !also_last) return;
  for (OpenGoal& goal : open) {
    if (goal.is_settled) continue;
    if (stays_at(robot, goal.goal) && !also_last) return;
    const std::size_t before = goal.chosen;
    std::size_t best = before;
    double earliest = kForever;
    for (std::size_t k = 0; k < goal.poses.size(); ++k) {
      if (stop.met()) break;
      if (goal.is_told && k != before) continue;
      choose(robot, goal, k);
      const double t = served_at(robot, goal, actions, also_last);
      if (t < earliest) best = k;
      earliest = std::min(earliest, t);
    }
    choose(robot, goal, best);
    if (earliest == kForever) return;  // nor are those after it
    goal.is_settled = true;
  }
}

void choose_unserved(Robot& robot, std::vector<OpenGoal>& open, std::span<const Action> actions,
                     const StopCondition& stop) {
  const auto goal =
      std::find_if(open.begin(), open.end(), [](const OpenGoal& one) { return !one.is_settled; });
  if (goal == open.end()) return;
  const std::size_t before = goal->chosen;
  bool any_serves = false;
  std::optional<std::size_t> unserved;
  std::optional<std::size_t> last;
  for (std::size_t k = 0; k < goal->poses.size() && !stop.met(); ++k) {
    choose(robot, *goal, k);
    const ServedGoals served = served_goals(robot, actions);
    if (served.visits.size() > goal->goal) {
      any_serves = true;
    } else if (served.in_next_pose && served.visits.size() == goal->goal) {
      last = k;
    } else if (!unserved || k == before) {
      unserved = k;
    }
  }
  const std::optional<std::size_t> pose = last ? last : unserved;
  goal->is_settled = any_serves && pose;
  choose(robot, *goal, goal->is_settled ? *pose : before);
}

}  // namespace fleetplan::core
