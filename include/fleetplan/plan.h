#pragma once

#include <fleetplan/action.h>
#include <fleetplan/fault.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace fleetplan {

/// A visit of a robot to one of its goals.
struct Visit {
  std::size_t goal = 0;                    // number of the goal in Robot::goals
  double t_arrive = 0.0;                   // seconds; begin of the rest in the goal pose
  std::optional<double> t_leave = {};      // seconds, the end of the service; none at the last goal
  std::optional<std::size_t> choice = {};  // number of the pose in Goal::any_of; none: the goal has one pose
  std::optional<Position> place = {};      // where a goal with a tolerance is served
};

/// When a robot would arrive at a goal that its plan does not reach.
struct EstimatedVisit {
  std::size_t goal = 0;   // number of the goal in Robot::goals
  double t_arrive = 0.0;  // seconds; infinite if it has no way
};

/// The plan of one robot.
struct RobotPlan {
  std::size_t robot = 0;  // number of the robot in Problem::robots
  double cost = 0.0;      // seconds: when it has come to rest in its last goal, where it stays
  /// The actions, contiguous in time and space from t = 0 in the start pose, the committed ones first. Empty
  /// if the robot need not move.
  std::vector<Action> actions = {};
  double lower_bound = 0.0;        // seconds: no plan for the robot alone on the map costs less
  std::vector<Visit> visits = {};  // one for each goal, in their order
  /// Seconds, if the plan stops at the horizon: `cost` and an estimate of the way that is left. Infinite if
  /// robots that stay where they are leave no way.
  std::optional<double> estimated_cost = {};
  /// If the plan stops at the horizon: one for each goal that is left, in their order.
  std::vector<EstimatedVisit> estimated_visits = {};
  /// Whether the plan stops at the horizon, and brings the robot no nearer to its goals.
  bool stuck = false;
  std::vector<std::size_t> blocked_by =
      {};  // if it is stuck: the robots in its way, as far as they are known
};

/// A robot without a plan. It executes its committed actions, if it has any, and stays at their end or at its
/// start. The plans of other robots keep clear of it.
struct Unplanned {
  enum class Reason {
    start_blocked,         // it cannot leave its start
    goal_blocked,          // it does not fit at a goal
    goal_unreachable,      // no way leads to a goal
    blocked_by_robots,     // robots that stay are in its way: `blocked_by`
    budget_exhausted,      // the time or the memory was spent first
    committed_in_the_way,  // committed motion or an obstacle passes where it stands: Plan::unavoidable
    invalid,               // its poses or committed actions collide: `faults`; see Options::invalid_robots
  };
  std::size_t robot = 0;
  Reason reason = Reason::budget_exhausted;
  std::string detail = {};                   // a sentence for people
  std::vector<std::size_t> blocked_by = {};  // ascending; the first twenty
  std::vector<Fault> faults = {};            // of an invalid robot
};

/// A collision that no plan prevents. For example, a robot cannot leave its place before the committed motion
/// of another robot passes there. An obstacle can pass there, too.
struct UnavoidableCollision {
  std::size_t robot = 0;
  std::optional<std::size_t> other = {};     // another robot, or
  std::optional<std::size_t> obstacle = {};  // an obstacle
  double t = 0.0;                            // seconds; when the overlap begins
};

/// The sum and the maximum of the planned robots' costs, seconds.
struct Objectives {
  double flowtime = 0.0;
  double makespan = 0.0;
};

/// How many robots a method of the planner tried to plan. A robot counts each time.
struct MethodCounts {
  std::int64_t tried = 0;
  std::int64_t served = 0;           // robots with a plan of this method, or with a plan that it may change
  std::int64_t could_not_serve = 0;  // robots that it does not support, for what they or the options ask for
};

/// What the search did.
struct SearchStatistics {
  std::int64_t attempts = 0;      // priority orders tried
  std::int64_t expansions = 0;    // search labels expanded
  std::int64_t improvements = 0;  // found in mode `anytime`
  bool exhausted = false;         // more time would change nothing
  // The methods, in this order:
  //
  // - priorities: one robot after the other.
  // - steps: all robots at once, step by step.
  // - room: two robots that meet get room to pass each other.
  // - smoothing: paths leave the lattice.
  // - improvement: a few robots at a time get other plans.
  MethodCounts priorities, steps, room, smoothing, improvement;
  double seconds = 0.0;  // planning, without reading the problem and without the check
};

/// The result of the planner. Every robot is in exactly one of `plans` and `unplanned`, which are in the
/// order of Problem::robots.
struct Plan {
  enum class Status {
    solved,   // every robot has a plan
    partial,  // some robots have
    none,
  };
  Status status = Status::none;
  std::vector<RobotPlan> plans = {};
  std::vector<Unplanned> unplanned = {};
  std::vector<UnavoidableCollision> unavoidable = {};  // by time
  Objectives objectives;
  /// The value of Options::objective, seconds. Plans that stop at the horizon count with their estimates.
  double objective_value = 0.0;
  Objectives lower_bound;  // objectives of the planned robots' lower bounds
  /// Whether the independent checker (verify.h) has found no violation. If the time does not suffice, all
  /// robots that would move stay where they are. False only if not even this could be checked. A plan that
  /// the checker rejects is never returned, see plan().
  bool verified = false;
  /// Metres: the smallest gap between two disks over all time. None for fewer than two robots, or if the plan
  /// is not verified.
  std::optional<double> min_clearance = {};
  /// Whether the plan depends only on the problem, the options and the build. False if the clock influenced
  /// it.
  bool deterministic = true;
  SearchStatistics search;

  /// Returns the plan of a robot; null if it has none.
  const RobotPlan* plan_of(std::size_t robot) const;
};

}  // namespace fleetplan
