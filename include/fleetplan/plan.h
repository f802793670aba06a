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

/// When a robot would come to a goal that its plan does not reach.
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
  /// Seconds, if the plan stops at the horizon: `cost` and an estimate of the way that is left; infinite if
  /// robots that stay where they are leave the robot no way.
  std::optional<double> estimated_cost = {};
  /// If the plan stops at the horizon: one for each goal that is left, in their order.
  std::vector<EstimatedVisit> estimated_visits = {};
  /// Whether the plan stops at the horizon, and the robot gains nothing on the way to its goals until then.
  bool stuck = false;
  std::vector<std::size_t> blocked_by =
      {};  // if it is stuck: the robots in its way, as far as they are known
};

/// A robot without a plan. It executes its committed actions and stays at their end, or stays at its start;
/// the plans of other robots keep clear of it.
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

/// An unavoidable collision, which no plan prevents: a robot cannot leave its place in time before the
/// committed motion of another robot, or an obstacle, passes there.
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

/// How many robots a method of the planner was to plan; each time counts.
struct MethodCounts {
  std::int64_t tried = 0;
  std::int64_t served = 0;           // have a plan of it, or one that it may change
  std::int64_t could_not_serve = 0;  // for what they or the options ask for, it is not made
};

/// What the search did.
struct SearchStatistics {
  std::int64_t attempts = 0;      // priority orders tried
  std::int64_t expansions = 0;    // search labels expanded
  std::int64_t improvements = 0;  // found in mode `anytime`
  bool exhausted = false;         // more time would change nothing
  // The methods: one robot after the other, all at once in steps, with room for two where they meet, paths
  // without the lattice, other plans of a few robots.
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
  /// The value of Options::objective, seconds; by the estimates where plans stop at the horizon.
  double objective_value = 0.0;
  Objectives lower_bound;  // objectives of the planned robots' lower bounds
  /// Whether the independent checker (verify.h) has found no violation. If the time does not suffice, robots
  /// that would move stay; false only if not even that could be checked. A plan that it rejects is never
  /// returned, see plan().
  bool verified = false;
  /// Metres: the smallest gap between two disks over all time; none for fewer than two robots, or unless
  /// verified.
  std::optional<double> min_clearance = {};
  /// Whether the plan depends only on the problem, the options and the build. False if the clock influenced
  /// it.
  bool deterministic = true;
  SearchStatistics search;

  /// Returns the plan of a robot; null if it has none.
  const RobotPlan* plan_of(std::size_t robot) const;
};

}  // namespace fleetplan
