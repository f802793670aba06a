#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/geometry/position.h"
#include "core/model/robot_list.h"

namespace fleetplan::core {

/// One rotation, translation or wait of a robot, from one pose to another, at constant speed. Times in
/// seconds from the start of the plan.
struct Action {
  enum class Type { rotate, translate, wait };
  Type type = Type::wait;
  double t_start = 0.0;
  double t_end = 0.0;
  Pose from;
  Pose to;
};

/// The plan of one robot. The actions are contiguous in time and space, begin at t = 0 in the start pose and
/// end at `cost` in the goal pose, where the robot stays. A robot that does not need to move has no actions
/// and cost 0. `lower_bound` bounds the robot's cost alone on the static map from below and never exceeds
/// `cost`; the checker ignores it.
struct RobotPlan {
  std::size_t robot = 0;  // index into the problem's robots
  double cost = 0.0;      // seconds
  std::vector<Action> actions;
  double lower_bound = 0.0;  // seconds
};

/// A robot without a plan. It stays at its start, and the plans of other robots keep clear of it.
struct Unplanned {
  enum class Reason { start_blocked, goal_blocked, goal_unreachable, blocked_by_robots, budget_exhausted };
  std::size_t robot = 0;
  Reason reason = Reason::budget_exhausted;
  std::string detail;    // a sentence for people, without robot indices
  RobotList blocked_by;  // the blocking robots, ascending
};

/// The sum (flowtime) and the maximum (makespan) of the planned robots' costs, or of their lower bounds, in
/// seconds.
struct Objectives {
  double flowtime = 0.0;
  double makespan = 0.0;
};

/// Counts of the search for a plan.
struct SearchStatistics {
  std::int64_t attempts = 0;      // priority orders tried
  std::int64_t expansions = 0;    // search labels expanded
  std::int64_t improvements = 0;  // improvements found in mode `anytime`
  /// More time would change nothing: in mode `anytime` no robot can become cheaper, or no further attempt can
  /// plan a robot that is unplanned.
  bool exhausted = false;
};

/// The result of the planner. `plans` and `unplanned` are in the order of the problem's robots; every robot
/// is in exactly one of them.
struct Plan {
  std::vector<RobotPlan> plans;
  std::vector<Unplanned> unplanned;
  Objectives objectives;
  Objectives lower_bound;
  bool deterministic = true;  // false if the clock or the load influenced the plan
  SearchStatistics search;
};

}  // namespace fleetplan::core
