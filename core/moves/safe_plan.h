#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/fleet/plan_state.h"
#include "core/fleet/progress_report.h"
#include "core/model/plan.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// A plan that is safe as it is: robots without a trajectory stay at their starts.
struct SafePlan {
  struct Staying {
    std::size_t robot;
    bool has_no_path;  // among the other robots, according to its last search
  };
  std::vector<Staying> staying;  // ascending
  bool cut_off = false;          // the stop condition decided something
};

/// How long to look for the path of a robot: `brief` where another attempt at all robots may follow, `none`
/// to plan no robot that stays.
enum class Effort : std::uint8_t { none, brief, full };

/// Makes the plan in `state` safe. Robots of `unsolved` may have a trajectory; those of `given_up` stay at
/// their starts already. First, all robots without a trajectory stay at their starts, and so do robots whose
/// trajectories conflict with one that stays. Then those that stay are planned again one by one, with growing
/// effort, as long as that gives a robot a trajectory. When one has left its start, those that only had to
/// stay because of it follow their earlier trajectories again. The plan is safe after every step; once `stop`
/// is met, no search starts.
SafePlan make_safe(PlanState& state, const std::vector<std::size_t>& unsolved,
                   const std::vector<std::size_t>& given_up, Effort effort, const StopCondition& stop,
                   ProgressReport& progress);

/// A safe plan with its reservations, to return to.
struct PlanSnapshot {
  SafePlan plan;
  FleetReservations::Snapshot reservations;
};

/// Returns to the reservations of the plan. Returns whether searches may follow, which is not so when the
/// time is over.
bool return_to(FleetReservations& reservations, const PlanSnapshot& snapshot, const StopCondition& stop);

struct PartialPlan {
  std::vector<Unplanned> unplanned;  // ascending
  bool cut_off = false;              // the stop condition decided something
};

/// Returns the reasons of the robots that stay in `state`, and the robots that block them.
PartialPlan explain(PlanState& state, const SafePlan& plan, const StopCondition& stop);

}  // namespace fleetplan::core
