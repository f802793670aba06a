#include "core/explain/stuck.h"

#include <algorithm>
#include <cstdint>
#include <new>
#include <vector>

#include "core/explain/blocking_robots.h"
#include "core/fleet/enclosure.h"

namespace fleetplan::core {
namespace {

/// Steps of Enclosure for each robot: about 2 ms.
constexpr std::int64_t kStepsOfStuck = 50'000;

/// Without a way to its goals.
void have_no_way(RobotPlan& plan, const std::vector<std::size_t>& closed_by) {
  plan.blocked_by = closed_by;
  plan.estimated_cost = kForever;
  for (Visit& visit : plan.estimated_visits) visit.t_arrive = visit.t_leave = kForever;
}

void explain_stuck(PlanState& state, RobotPlan& plan, const std::vector<std::size_t>& staying,
                   BlockingRobots& blocking, const StopCondition& stop) {
  if (!staying.empty()) {
    const Enclosure::Result way = Enclosure(state.instance(), plan.robot, staying, stop).find(kStepsOfStuck);
    if (way.answer == Enclosure::Answer::closed) return have_no_way(plan, way.robots);
  }
  plan.blocked_by = blocking.find(plan.robot);
}

}  // namespace

Plan with_stuck_explained(PlanState& state, Plan plan, const StopCondition& stop) {
  const auto is_stuck = [](const RobotPlan& robot) { return robot.is_stuck; };
  if (std::none_of(plan.plans.begin(), plan.plans.end(), is_stuck)) return plan;
  try {
    state.reservations().resume();
    const std::vector<std::size_t> staying = state.reservations().staying_robots();
    BlockingRobots blocking(state, stop);
    for (RobotPlan& robot : plan.plans) {
      if (robot.is_stuck && !stop.met()) explain_stuck(state, robot, staying, blocking, stop);
    }
    if (stop.met()) plan.deterministic = false;
  } catch (const std::bad_alloc&) {  // not granted to the job: the others are stuck without a reason
    plan.deterministic = false;
  }
  plan.estimated = estimated_objectives(plan);
  return plan;
}

}  // namespace fleetplan::core
