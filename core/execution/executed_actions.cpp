#include "core/execution/executed_actions.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/model/itinerary.h"
#include "core/model/loads.h"

namespace fleetplan::core {

std::vector<Actions> executed_actions(const std::vector<Robot>& robots, const std::vector<RobotPlan>& plans) {
  std::vector<Actions> executed(robots.size());
  for (std::size_t k = 0; k < robots.size(); ++k) {
    if (!robots[k].invalid) executed[k] = robots[k].committed;
  }
  for (const RobotPlan& plan : plans) executed[plan.robot] = plan.actions;
  return executed;
}

double planned_time(Actions actions, std::size_t action, double fraction) {
  const Action& planned = actions[action];
  return fraction >= 1.0 ? planned.t_end : time_at_share(planned, fraction);
}

namespace {

/// Whether the action is directly before a translation.
bool precedes_translation(Actions actions, std::size_t index) {
  return index + 1 < actions.size() && actions[index + 1].type == Action::Type::translate;
}

}  // namespace

std::vector<WaitPurpose> wait_purposes(const Robot& robot, Actions actions, double wait_before_move) {
  std::vector<WaitPurpose> purposes(actions.size());
  for (std::size_t k = 0; k < actions.size(); ++k) {
    const Action& action = actions[k];
    if (action.type != Action::Type::wait) continue;
    const double planned = action.t_end - action.t_start;
    WaitPurpose& purpose = purposes[k];
    if (action.goal && *action.goal < robot.goal_count()) {
      const Goal& goal = robot.goal_at(*action.goal);
      purpose.least = std::min(planned, goal.service);
      purpose.not_before = std::min(goal.not_before, action.t_end - purpose.least);
    }
    if (!precedes_translation(actions, k)) continue;
    const double added = std::min(planned, wait_before_move);
    if (added <= purpose.least) continue;
    purpose.not_before = std::max(0.0, purpose.not_before - (added - purpose.least));
    purpose.least = added;
  }
  return purposes;
}

namespace {

/// The radii of a robot while it executes its actions.
class Radii {
 public:
  Radii(const Robot& robot, Actions actions) : radii_(radii_of(robot)) {
    if (changes_radius(robot)) visits_ = visits_of(robot, actions);
  }

  /// Returns the largest radius during an action, its end included. Call it for the actions in their order.
  double during(const Action& action, bool is_last) {
    while (served_ < visits_.size() && visits_[served_].t_leave <= action.t_start) ++served_;
    double largest = radii_[served_];
    for (std::size_t k = served_; k < visits_.size(); ++k) {
      const bool ends = is_last || visits_[k].t_leave <= action.t_end || action.goal == visits_[k].goal;
      if (!ends) break;
      largest = std::max(largest, radii_[k + 1]);
    }
    return largest;
  }

  /// The radius after the last action.
  double at_rest() const { return radii_[visits_.size()]; }

 private:
  std::vector<double> radii_;  // by the number of goals served
  std::vector<Visit> visits_;  // the visits to all goals, in order
  std::size_t served_ = 0;
};

/// Adds a stretch for a translation or, with a profile, for each of its phases.
void add_translation(const TimedSegment& move, const Action& action, double index, double radius,
                     std::vector<PlannedStretch>& stretches) {
  if (!action.profile || move.path.length() <= 0.0 || move.duration() <= 0.0) {
    stretches.push_back({move, index, 1.0, radius, true});
    return;
  }
  const double length = move.path.length();
  double begin = 0.0;  // share of the translation
  for (const TimedSegment& phase : phases(move, *action.profile)) {
    const double end = std::min(1.0, (phase.path.to - move.path.from).norm() / length);
    stretches.push_back({phase, index + begin, end - begin, radius, true});
    begin = end;
  }
}

TimedSegment standing(const Position& position, double t_start, double t_end) {
  return {{position, position}, t_start, t_end};
}

}  // namespace

double Pace::progress_at(double t) const {
  const auto under_way =
      std::upper_bound(actions_.begin(), actions_.end(), t,
                       [](double time, const Action& action) { return time < action.t_end; });
  const auto index = static_cast<double>(under_way - actions_.begin());
  if (under_way == actions_.end() || t <= under_way->t_start) return index;
  return index + share_at(*under_way, t);
}

double Pace::time_at(double progress) const {
  if (actions_.empty()) return 0.0;
  const ActionProgress at = until(0, progress);
  return planned_time(actions_, at.action, at.fraction);
}

ActionProgress Pace::gate(std::size_t robot, double progress) const {
  const double most = static_cast<double>(actions_.size()) - 1.0;
  const double action = std::clamp(std::floor(progress), 0.0, most);
  return {robot, static_cast<std::size_t>(action), std::clamp(progress - action, 0.0, 1.0)};
}

ActionProgress Pace::until(std::size_t robot, double progress) const {
  const double most = static_cast<double>(actions_.size()) - 1.0;
  const double action = std::clamp(std::ceil(progress) - 1.0, 0.0, most);
  return {robot, static_cast<std::size_t>(action), std::clamp(progress - action, 0.0, 1.0)};
}

std::vector<PlannedStretch> stretches_of(const Robot& robot, Actions actions, double margin) {
  std::vector<PlannedStretch> stretches;
  Radii radii(robot, actions);
  Position place = robot.start.position;
  double now = 0.0;
  double before = robot.radius + margin;
  for (std::size_t k = 0; k < actions.size(); ++k) {
    const Action& action = actions[k];
    const double radius = radii.during(action, k + 1 == actions.size()) + margin;
    const auto index = static_cast<double>(k);
    const bool moves = action.type == Action::Type::translate;
    if (moves) {
      add_translation({{place, action.to.position}, now, action.t_end}, action, index, radius, stretches);
      place = action.to.position;
    } else if (!stretches.empty() && stretches.back().radius == radius &&
               stretches.back().planned.path.from == stretches.back().planned.path.to) {
      stretches.back().planned.t_end = action.t_end;
      stretches.back().length += 1.0;
    } else {
      stretches.push_back({standing(place, now, action.t_end), index, 1.0, radius, radius > before});
    }
    before = radius;
    now = action.t_end;
  }
  const double radius = radii.at_rest() + margin;
  stretches.push_back(
      {standing(place, now, kForever), static_cast<double>(actions.size()), 0.0, radius, false});
  return stretches;
}

}  // namespace fleetplan::core
