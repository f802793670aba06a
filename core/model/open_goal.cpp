#include "core/model/open_goal.h"

#include <algorithm>
#include <numbers>
#include <optional>

#include "core/geometry/elementary_functions.h"
#include "core/geometry/segment.h"
#include "core/geometry/tolerance.h"
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

/// The cost of places near a goal's pose is at least this, seconds, and grows with each metre. It is more
/// than any way takes, and less than the cost of changing to another pose (pose_choice.cpp).
constexpr double kBiasOfPlaces = 4e5;
/// Where places are tried: circles, and places on each.
constexpr int kCircles = 8;
constexpr int kDirections = 12;

double bias_at(double distance) { return kBiasOfPlaces * (1.0 + distance); }

}  // namespace

void widen(OpenGoal& open) {
  open.is_widened = true;
  // Bounded: kCircles, kDirections.
  for (int circle = 1; circle <= kCircles; ++circle) {
    const double distance = open.tolerance * circle / kCircles;
    for (int k = 0; k < kDirections; ++k) {
      const Position way = distance * unit_vector(2.0 * std::numbers::pi * k / kDirections);
      open.poses.push_back({open.own + way, open.poses.front().theta, bias_at(distance)});
    }
  }
}

bool take_place(OpenGoal& open, const Position& place) {
  const double distance = (place - open.own).norm();
  if (distance > open.tolerance + kContactTolerance) return false;
  open.poses.resize(1);
  if (distance > kContactTolerance) {
    open.poses.push_back({place, open.poses.front().theta, bias_at(distance)});
  }
  open.chosen = open.poses.size() - 1;
  return true;
}

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

OpenLoadOnTheWay::OpenLoadOnTheWay(const Robot& robot, const std::vector<OpenGoal>& open)
    : robot_(robot), open_(open), on_the_way_(settled_at_start()) {}

/// A goal that is not served at the start is settled again.
const Robot& OpenLoadOnTheWay::settled_at_start() {
  // Bounded: the poses of open goals, each once.
  for (std::size_t k = 0; k < open_.size(); ++k) settle(open_[k].goal, robot_.start);
  return robot_;
}

void OpenLoadOnTheWay::execute(const Action& action) {
  // Bounded: the goals in one pose, each once.
  for (bool goes_on = true; goes_on;) {
    const std::size_t before = on_the_way_.served();
    settle(before, action.to);
    on_the_way_.execute(action);
    goes_on = on_the_way_.served() != before;
  }
}

/// Chooses the pose of the goal that the robot is in, if the goal is open.
void OpenLoadOnTheWay::settle(std::size_t goal, const Pose& pose) {
  OpenGoal* open = find_open(open_, goal);
  if (open == nullptr || open->is_told) return;
  // Bounded: a hundred poses.
  for (std::size_t k = 0; k < open->poses.size(); ++k) {
    if (!is_in_pose(pose, {open->poses[k].position, open->poses[k].theta})) continue;
    return choose(robot_, *open, k);
  }
}

}  // namespace fleetplan::core
