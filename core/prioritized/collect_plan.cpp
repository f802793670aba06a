#include "core/prioritized/collect_plan.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <new>
#include <utility>

#include "core/geometry/tolerance.h"
#include "core/instance/to_actions.h"
#include "core/model/itinerary.h"
#include "core/prioritized/enclosure.h"
#include "core/prioritized/partial_plan.h"

namespace fleetplan::core {
namespace {

/// Removes goals from waits that serve none. The search may let a robot rest for long enough in a goal's pose
/// and serve the goal when it comes back. The goal counts as served by the first rest, so the later wait is
/// for none.
void remove_wrong_goals(std::vector<Action>& actions, const std::vector<Visit>& visits, std::size_t first) {
  for (std::size_t i = first; i < actions.size(); ++i) {
    std::optional<std::size_t>& goal = actions[i].goal;
    if (goal && *goal < visits.size() && visits[*goal].t_leave <= actions[i].t_start) goal.reset();
  }
}

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
  const double served = std::max(visits.back().t_arrive, robot.goal->not_before) + robot.goal->service;
  if (served > stops_at + kSameTime) visits.pop_back();
}

RobotPlan robot_plan(const PlanState& state, std::size_t index, double bound) {
  const auto& trajectory = state.trajectory(index);
  const Robot& robot = state.instance().robot(index);
  if (!trajectory)
    return {index, robot.committed_until(), robot.committed, robot.committed_until()};  // parked
  const double cost = trajectory->stops_at.value_or(trajectory->cost);
  if (trajectory->is_previous) {
    const std::vector<Action>& actions = previous_actions(robot);
    return {index, cost, actions, std::min(bound, cost), visits_of(robot, actions)};
  }
  // Rounding may leave a bound slightly above the cost that it bounds.
  std::vector<Action> actions = to_actions(robot, *trajectory, state.instance().drive_zones(index));
  std::vector<Visit> visits = visits_of(robot, actions);
  remove_wrong_goals(actions, visits, robot.committed.size());
  if (trajectory->stops_at) remove_unserved_last(visits, robot, *trajectory->stops_at);
  RobotPlan plan{index, cost, std::move(actions), std::min(bound, cost), std::move(visits)};
  if (trajectory->stops_at) {
    add_estimates(plan, *trajectory, commitment_gains(robot, state.instance().itinerary(index)));
  }
  return plan;
}

/// The objectives of the estimates, without robots that have none.
Objectives estimated_objectives(const Plan& plan) {
  Objectives estimated;
  for (const RobotPlan& robot : plan.plans) {
    const double cost = robot.estimated_cost.value_or(robot.cost);
    if (cost < kForever) estimated = including(estimated, cost);
  }
  return estimated;
}

}  // namespace

Plan collect_plan(const PlanState& state, const std::vector<std::optional<Unplanned>>& unplanned,
                  const TautPathBounds& bounds) {
  Plan plan;
  const std::optional<double>& horizon = state.instance().options().horizon;
  for (std::size_t i = 0; i < state.instance().size(); ++i) {
    if (unplanned[i]) {
      plan.unplanned.push_back(*unplanned[i]);
      continue;
    }
    // With a horizon, a plan may stop there, or where the committed actions end if that is later.
    double bound = bounds[i];
    if (horizon) bound = std::min(bound, std::max(*horizon, state.instance().itinerary(i).t_begin));
    const RobotPlan& robot = plan.plans.emplace_back(robot_plan(state, i, bound));
    plan.objectives = including(plan.objectives, robot.cost);
    plan.lower_bound = including(plan.lower_bound, robot.lower_bound);
  }
  if (horizon) plan.estimated = estimated_objectives(plan);
  return plan;
}

namespace {

/// Steps of Enclosure for each robot: about 2 ms.
constexpr std::int64_t kStepsOfStuck = 50'000;

std::vector<std::size_t> robots_that_stay(const PlanState& state) {
  const std::vector<double>& until = state.reservations().at_start_until;
  std::vector<std::size_t> staying;
  for (std::size_t robot = 0; robot < until.size(); ++robot) {
    if (until[robot] == kForever) staying.push_back(robot);
  }
  return staying;
}

/// Without a way to its goals.
void have_no_way(RobotPlan& plan, const std::vector<std::size_t>& closed_by) {
  plan.blocked_by = closed_by;
  plan.estimated_cost = kForever;
  for (Visit& visit : plan.estimated_visits) visit.t_arrive = visit.t_leave = kForever;
}

void explain_stuck(PlanState& state, RobotPlan& plan, const std::vector<std::size_t>& staying,
                   BlockingRobots& blocking) {
  if (!staying.empty()) {
    const Enclosure::Result way = Enclosure(state.instance(), plan.robot, staying).find(kStepsOfStuck);
    if (way.answer == Enclosure::Answer::closed) return have_no_way(plan, way.robots);
  }
  plan.blocked_by = blocking.find(plan.robot);
}

}  // namespace

Plan with_stuck_explained(PlanState& state, Plan plan, const StopCondition& stop) {
  const auto is_stuck = [](const RobotPlan& robot) { return robot.is_stuck; };
  if (std::none_of(plan.plans.begin(), plan.plans.end(), is_stuck)) return plan;
  try {
    state.resume();
    const std::vector<std::size_t> staying = robots_that_stay(state);
    BlockingRobots blocking(state, stop);
    for (RobotPlan& robot : plan.plans) {
      if (robot.is_stuck && !stop.met()) explain_stuck(state, robot, staying, blocking);
    }
    if (stop.met()) plan.deterministic = false;
  } catch (const std::bad_alloc&) {  // not granted to the job: the others are stuck without a reason
    plan.deterministic = false;
  }
  plan.estimated = estimated_objectives(plan);
  return plan;
}

}  // namespace fleetplan::core
