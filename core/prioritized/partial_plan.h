#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/model/plan.h"
#include "core/prioritized/plan_state.h"
#include "core/prioritized/progress_report.h"
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

/// Finds the robots that keep another one from its goal. The effort for all calls together is limited, to
/// about a tenth of a second.
class BlockingRobots {
 public:
  /// The arguments outlive this object.
  BlockingRobots(PlanState& state, const StopCondition& stop) : state_(state), stop_(stop) {}

  /// Returns the robots that keep `robot` from its goal, ascending. The robot stays at its start and has no
  /// path among the others, or follows a trajectory that gains nothing; it does so afterwards, too. The
  /// search begins with the robots that conflict with the path that it would take alone on the map, and
  /// removes one after the other as long as ignoring the rest still gives it a path, or one that gains
  /// something. Returns more robots than necessary if the effort or `stop` ends this early; none if `stop` is
  /// met already.
  std::vector<std::size_t> find(std::size_t robot);

 private:
  PlanState& state_;
  const StopCondition& stop_;
  std::int64_t expansions_ = 0;
};

/// Returns the reasons of the robots that stay in `state`, and the robots that block them.
PartialPlan explain(PlanState& state, const SafePlan& plan, const StopCondition& stop);

}  // namespace fleetplan::core
