#include "core/plan/collect_plan.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "core/geometry/elementary_functions.h"
#include "core/geometry/position.h"
#include "core/geometry/tolerance.h"
#include "core/model/itinerary.h"

namespace fleetplan::core {
namespace {

/// Whether the committed actions of a robot may bring it nearer to its goals: they move it, or serve a goal.
bool commitment_gains(const Robot& robot, const Itinerary& itinerary) {
  return !itinerary.visited.empty() || itinerary.service_done > 0.0 ||
         std::any_of(robot.committed.begin(), robot.committed.end(),
                     [](const Action& action) { return action.type == Action::Type::translate; });
}

/// Adds to a plan that stops at the horizon what is left.
void add_estimates(RobotPlan& plan, const Trajectory& trajectory, bool has_gained) {
  plan.estimated_cost = trajectory.cost;
  plan.estimated_visits = trajectory.estimated_visits;
  const auto is_served = [&](const Visit& visit) { return visit.goal < plan.visits.size(); };
  std::erase_if(plan.estimated_visits, is_served);
  plan.is_stuck = trajectory.gains_nothing && !has_gained;
}

/// Removes the visit to the last goal from a plan that stops there before its service is over.
void remove_unserved_last(std::vector<Visit>& visits, const Robot& robot, double stops_at) {
  if (visits.size() < robot.goal_count() || visits.empty()) return;
  const double served = robot.goal->service_end(visits.back().t_arrive);
  if (served > stops_at + kSameTime) visits.pop_back();
}

/// Removes goals that are not served from waits of a plan that stops, from an action on.
void remove_unserved_goals(std::vector<Action>& actions, std::size_t served, std::size_t first) {
  for (std::size_t k = first; k < actions.size(); ++k) {
    if (actions[k].goal && *actions[k].goal >= served) actions[k].goal.reset();
  }
}

RobotPlan robot_plan(const FleetReservations& reservations, std::size_t index, double bound) {
  const auto& trajectory = reservations.trajectory(index);
  const Instance& instance = reservations.instance();
  const Robot& robot = instance.problem().robots()[index];
  if (!trajectory)
    return {index, robot.committed_until(), robot.committed, robot.committed_until()};  // parked
  const double cost = trajectory->stops_at.value_or(trajectory->cost);
  if (trajectory->is_previous) {
    std::vector<Action> actions = previous_actions(robot);
    std::vector<Visit> visits = visits_of(robot, actions);
    mark_services(robot, actions, actions.size());
    return {index, cost, std::move(actions), std::min(bound, cost), std::move(visits)};
  }
  // Rounding may leave a bound slightly above the cost that it bounds.
  std::vector<Action> actions = to_actions(robot, *trajectory, instance.views(index)[0].zones.get());
  std::vector<Visit> visits = visits_of(robot, actions);
  // The search may let a robot rest for long enough in a goal's pose and serve the goal when it comes back.
  // The goal counts as served by the first rest, so the later wait is for none.
  mark_services(robot, actions, robot.committed.size());
  if (trajectory->stops_at) {
    remove_unserved_last(visits, robot, *trajectory->stops_at);
    remove_unserved_goals(actions, visits.size(), robot.committed.size());
  }
  RobotPlan plan{index, cost, std::move(actions), std::min(bound, cost), std::move(visits)};
  if (trajectory->stops_at) {
    add_estimates(plan, *trajectory, commitment_gains(robot, instance.itinerary(index)));
  }
  return plan;
}

}  // namespace

Plan collect_plan(const FleetReservations& reservations,
                  const std::vector<std::optional<Unplanned>>& unplanned, const TautPathBounds& bounds) {
  Plan plan;
  const Instance& instance = reservations.instance();
  const std::optional<double>& horizon = instance.options().horizon;
  for (std::size_t i = 0; i < instance.size(); ++i) {
    if (unplanned[i]) {
      plan.unplanned.push_back(*unplanned[i]);
      continue;
    }
    // With a horizon, a plan may stop there, or where the committed actions end if that is later.
    double bound = bounds[i];
    if (horizon) bound = std::min(bound, std::max(*horizon, instance.itinerary(i).t_begin));
    const RobotPlan& robot = plan.plans.emplace_back(robot_plan(reservations, i, bound));
    plan.objectives = including(plan.objectives, robot.cost);
    plan.lower_bound = including(plan.lower_bound, robot.lower_bound);
  }
  if (horizon) plan.estimated = estimated_objectives(plan);
  return plan;
}

namespace {

/// Seconds; smaller waits are rounding. Far below the tolerances of the verifier.
constexpr double kNegligible = 1e-12;
/// Seconds: rounding of the end of a rotation before a visit.
constexpr double kRounding = 1e-9;

/// Where the search has less than kLeastAction, the robot is there, or as good as turned. A wait of less
/// belongs to the action before it; a service, or a wait behind committed actions, takes longer.
class ActionList {
 public:
  /// Begins with the committed actions.
  ActionList(const Robot& robot, const DriveZones* zones)
      : robot_(robot),
        zones_(zones),
        pose_(robot.committed_end()),
        now_(robot.committed_until()),
        actions_(robot.committed) {}

  /// Rotates to a heading before a move of no length: a place off the lattice may be one on it, too.
  void turn(double theta, double t_end) { rotate(theta, t_end, kNegligible); }
  /// Whether a move to there leads anywhere.
  bool is_elsewhere(const Position& to) const { return (to - pose_.position).norm() >= kLeastAction; }
  /// Stays instead of a move that leads nowhere.
  void stay(double t_end) {
    if (t_end - now_ >= kLeastAction) wait(t_end, {});
  }
  /// Rotates to a heading, then waits until `t_end`.
  void rotate_and_wait(double theta, double t_end) {
    rotate(theta, t_end, kNegligible);
    wait(t_end, {});
  }
  /// Rests in the pose of a goal, and waits there until its service ends.
  void visit(const Visit& visit) {
    const auto& theta = robot_.goal_at(visit.goal).theta;
    // A rest that the committed actions have begun goes on, as exactly in the pose as it is.
    if (theta && visit.t_arrive - now_ > kNegligible) rotate(*theta, visit.t_arrive, kRounding);
    wait(visit.t_arrive, {});
    wait(visit.t_leave, visit.goal);
  }
  void visit_last(double t_leave) {
    const Goal& goal = *robot_.goal;
    const bool goes_on = !robot_.committed.empty() && is_at_committed_end() && is_in_pose(pose_, goal);
    if (goal.theta && !goes_on) rotate(*goal.theta, t_leave, kNegligible);
    const bool serves = goal.service > 0.0 || goal.not_before > 0.0;
    if (goal.theta || serves) wait(t_leave, serves ? std::optional(robot_.via.size()) : std::nullopt);
  }
  void translate(const TimedMove& move) {
    append(Action::Type::translate, std::max(now_, move.t_end), {move.path.to, pose_.theta}, {});
    actions_.back().reverse = move.reverse;
    actions_.back().profile = move.profile;
  }
  void wait(double t_end, std::optional<std::size_t> goal) {
    if (t_end - now_ <= kNegligible) return;
    const bool is_too_short = t_end - now_ < kLeastAction;
    if (is_too_short && !goal && !is_at_committed_end()) {
      actions_.back().t_end = now_ = t_end;
    } else {
      append(Action::Type::wait, is_too_short ? now_ + kShortestWait : t_end, pose_, goal);
    }
  }
  std::vector<Action> take() { return std::move(actions_); }

 private:
  bool is_at_committed_end() const { return actions_.size() == robot_.committed.size(); }
  /// The rotation ends at `t_end` if that is right up to `rounding` seconds.
  void rotate(double theta, double t_end, double rounding) {
    const double rotation = std::abs(rotation_between(pose_.theta, theta));
    if (rotation < kLeastAction) return;
    const double speed = zones_ != nullptr ? zones_->angular_speed_at(pose_.position) : robot_.angular_speed;
    const Inertia inertia = robot_.angular_inertia();
    double rotated = now_ + inertia.time(rotation, speed);
    if (std::abs(t_end - rotated) <= rounding) rotated = t_end;
    append(Action::Type::rotate, rotated, {pose_.position, theta}, {});
    if (inertia.is_limited) actions_.back().profile = fastest_profile(rotation, speed, inertia);
  }
  void append(Action::Type type, double t_end, const Pose& to, std::optional<std::size_t> goal) {
    actions_.push_back({type, now_, t_end, pose_, to, goal});
    now_ = t_end;
    pose_ = to;
  }

  const Robot& robot_;
  const DriveZones* zones_;  // null for none
  Pose pose_;
  double now_;
  std::vector<Action> actions_;
};

/// The index of the first one after the committed actions.
std::size_t first_planned_move(const Robot& robot, const Trajectory& trajectory) {
  const double t_begin = robot.committed_until();
  const auto first = std::find_if(trajectory.moves.begin(), trajectory.moves.end(),
                                  [&](const TimedMove& move) { return move.t_start >= t_begin; });
  return static_cast<std::size_t>(first - trajectory.moves.begin());
}

/// The direction of a move and of the moves that go on from it.
double heading_from(const std::vector<TimedMove>& moves, std::size_t first) {
  std::size_t last = first;
  while (last + 1 < moves.size() && moves[last + 1].continues) ++last;
  const Position direction = moves[last].path.to - moves[first].path.from;
  return heading_of(direction);
}

}  // namespace

std::vector<Action> to_actions(const Robot& robot, const Trajectory& trajectory, const DriveZones* zones) {
  ActionList list(robot, zones);
  auto visit = trajectory.visits.begin();
  for (std::size_t k = first_planned_move(robot, trajectory); k < trajectory.moves.size(); ++k) {
    const TimedMove& move = trajectory.moves[k];
    for (; visit != trajectory.visits.end() && visit->t_leave <= move.t_start; ++visit) list.visit(*visit);
    const bool has_length = move.path.from != move.path.to;
    const bool moves = has_length && list.is_elsewhere(move.path.to);
    if (has_length && !moves) {
      list.stay(move.t_end);
      continue;
    }
    if (!move.continues) {
      const double direction = heading_from(trajectory.moves, k);
      const double heading = move.reverse ? opposite_heading(direction) : direction;
      moves ? list.rotate_and_wait(heading, move.t_start) : list.turn(heading, move.t_start);
    }
    if (moves) list.translate(move);
  }
  for (; visit != trajectory.visits.end(); ++visit) list.visit(*visit);
  if (trajectory.stops_at) {
    list.wait(*trajectory.stops_at, {});
  } else if (robot.goal) {
    list.visit_last(trajectory.cost);
  }
  return list.take();
}

}  // namespace fleetplan::core
