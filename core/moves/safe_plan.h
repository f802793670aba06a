#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/fleet/plan_state.h"
#include "core/fleet/progress_report.h"
#include "core/model/plan.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// A plan that is safe as it is. Robots without a trajectory stay at their starts.
struct SafePlan {
  struct Staying {
    std::size_t robot;
    bool has_no_path;  // among the other robots, according to its last search
  };
  std::vector<Staying> staying;  // ascending
  bool cut_off = false;          // the stop condition decided something
};

/// How much effort a robot's path gets. `brief`: another attempt at all robots may follow. `none`: robots
/// that stay are not planned.
enum class Effort : std::uint8_t { none, brief, full };

/// Makes the plan in `state` safe. Robots of `unsolved` may have a trajectory; robots of `given_up` stay at
/// their starts already.
///
/// 1. All robots without a trajectory stay at their starts.
/// 2. A robot whose trajectory conflicts with a robot that stays is planned around it. If the time does not
///    suffice for all such robots, or one finds no way, it stays as well.
/// 3. The robots that stay are planned one by one with growing effort, as long as that gives a robot a
///    trajectory. When a robot has left its start, the robots that stayed only because of it follow their
///    earlier trajectories again.
///
/// The plan is safe after step 2 and after each robot of step 3. Once `stop` is met, no search starts.
SafePlan make_safe(PlanState& state, const std::vector<std::size_t>& unsolved,
                   const std::vector<std::size_t>& given_up, Effort effort, const StopCondition& stop,
                   ProgressReport& progress);

/// A safe plan with its reservations, to return to.
struct PlanSnapshot {
  SafePlan plan;
  FleetReservations::Snapshot reservations;
};

/// Returns to the reservations of the plan. Returns whether searches may follow; false when the time is over.
bool return_to(FleetReservations& reservations, const PlanSnapshot& snapshot, const StopCondition& stop);

struct PartialPlan {
  std::vector<Unplanned> unplanned;  // ascending
  bool cut_off = false;              // the stop condition decided something
};

/// Returns, for the robots that stay in `state`, the reasons and the robots that block them.
PartialPlan explain(PlanState& state, const SafePlan& plan, const StopCondition& stop);

}  // namespace fleetplan::core
