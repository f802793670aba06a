#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/geometry/position.h"

namespace fleetplan::core {

/// One thing that a robot executes, from one pose to another, at constant speed. Times in seconds from the
/// start of the plan.
struct Action {
  enum class Type { rotate, translate, wait };
  Type type = Type::wait;
  double t_start = 0.0;
  double t_end = 0.0;
  Pose from;
  Pose to;
};

/// What one robot does. Actions are contiguous in time and space and begin at t = 0 in the start pose; at
/// `cost` the robot has come to rest in its goal pose for good. Empty, with cost 0, for a robot that need not
/// move. `lower_bound` is what the robot would cost alone on the static map, or less, and never more than
/// `cost`; no check looks at it.
struct RobotPlan {
  std::size_t robot = 0;  // index into the problem's robots
  double cost = 0.0;      // seconds
  std::vector<Action> actions;
  double lower_bound = 0.0;  // seconds
};

/// A robot without a plan: it stays at its start, and no plan crosses it.
struct Unplanned {
  enum class Reason { start_blocked, goal_blocked, goal_unreachable, blocked_by_robots, budget_exhausted };
  std::size_t robot = 0;
  Reason reason = Reason::budget_exhausted;
  std::string detail;                   // a sentence for people; names no robots by index
  std::vector<std::size_t> blocked_by;  // indices of the robots in the way, ascending
};

/// Of the planned robots' costs, or of their lower bounds: flowtime is the sum, makespan the maximum,
/// seconds.
struct Objectives {
  double flowtime = 0.0;
  double makespan = 0.0;
};

/// How the plan was found.
struct SearchStatistics {
  std::int64_t attempts = 0;      // how often robots were ordered and planned
  std::int64_t expansions = 0;    // search labels expanded
  std::int64_t improvements = 0;  // how often `anytime` made the plan better
};

/// The planner's answer. `plans` and `unplanned` are in the order of the problem's robots; every robot is in
/// one.
struct Plan {
  std::vector<RobotPlan> plans;
  std::vector<Unplanned> unplanned;
  Objectives objectives;
  Objectives lower_bound;
  bool deterministic = true;  // neither the clock nor the load decided anything
  SearchStatistics search;
};

}  // namespace fleetplan::core
