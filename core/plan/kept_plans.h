#pragma once

// Previous plans: which of them hold, and plans that go on with them.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/model/plan.h"
#include "core/model/plan_options.h"
#include "core/model/problem.h"
#include "core/model/robot.h"
#include "core/model/trajectory.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

class FleetReservations;

/// Whether any robot has a previous plan.
bool have_previous_plans(const std::vector<Robot>& robots);

/// Returns these actions as a plan without visits, with 0 as lower bound.
RobotPlan previous_plan(std::size_t index, const Robot& robot);

/// Returns the motion of a previous plan that holds (see KeptPlans).
Trajectory previous_trajectory(const Robot& robot);

/// The previous plans that hold together.
struct KeptPlans {
  std::vector<bool> kept;  // by robot; empty if no robot has a previous plan
  bool cut_off = false;    // the check was not finished, so none is kept

  bool contains(std::size_t robot) const { return !kept.empty() && kept[robot]; }
};

/// What happens to robots whose previous plans are left out, while the other plans are judged.
enum class LeftOut : std::uint8_t {
  unknown,  // they will be planned, so no other robot conflicts with them here
  stay,     // they stay at their starts or committed ends for ever
};

/// Returns the previous plans that hold together. The checker judges them under the options' inflation,
/// interval margin, added waits and start overlap.
///
/// - Plans that violate the rules on their own are left out first.
/// - Then, of two plans that conflict, the one with the lower priority is left out.
/// - A robot without a previous plan, or with an empty one, has a plan without actions. It holds if the robot
///   is at rest at its last goal.
///
/// Takes as long as a check of the plans, or a few times as long if the robots left out stay.
KeptPlans keep_previous_plans(const Problem& problem, const PlanOptions& options, const StopCondition& stop,
                              LeftOut left_out = LeftOut::unknown);

/// Returns the kept plans that also hold if all other robots stay at their starts or committed ends.
KeptPlans keep_if_others_stay(const Problem& problem, const PlanOptions& options, const KeptPlans& previous,
                              const StopCondition& stop);

/// Lets robots follow their kept plans, unless the plan conflicts with a robot that stays. A plan in
/// `certain` holds if all others stay; its robot follows it in any case. Returns the number of robots that
/// follow a plan.
std::size_t follow_kept_plans(FleetReservations& reservations, const KeptPlans& previous,
                              const KeptPlans& certain);

/// Lets all `movers`, whose plans are kept, follow these plans. Takes hardly any time, and no search may
/// follow.
void finish_with_kept_plans(FleetReservations& reservations, const std::vector<std::size_t>& movers);

/// Returns the plan for which no search is needed. It contains parked robots, and robots whose previous plans
/// hold while all others stay at their starts or committed ends. The other robots are unplanned for lack of a
/// budget, with this detail.
///
/// Takes as long as a few checks of the plans. Keeps no previous plan if `stop` is met first.
Plan plan_without_search(const Problem& problem, const PlanOptions& options, const char* detail,
                         const StopCondition& stop);

}  // namespace fleetplan::core
