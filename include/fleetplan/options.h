#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

namespace fleetplan {

/// How to plan. Options have the same defaults and meanings as in the service: docs/plan_request.md, Options.
struct Options {
  enum class Mode {
    first,    // returns the first plan
    anytime,  // uses the rest of the time budget to improve it
  };
  enum class Objective {
    flowtime,   // the sum of the robots' costs, each times its weight
    makespan,   // their maximum
    tardiness,  // the sum of how much later than due they arrive at goals, each times the robot's weight
  };
  enum class Priority { shortest_first, longest_first, as_listed, random };
  enum class Reordering { raise_failed, random, none };
  enum class Replan {
    all,           // the search begins with the previous plans, and improves them
    where_needed,  // previous plans that hold are kept, unless a robot could not be planned otherwise
  };

  /// What becomes of robots whose poses or committed actions collide.
  enum class InvalidRobots {
    refuse,  // the problem is not valid
    report,  // they are unplanned (Unplanned::Reason::invalid) and stand at their starts; others are planned
  };

  /// The time for planning, > 0. The check of the plan may take a little longer. Robots that have no plan by
  /// then are unplanned.
  std::chrono::nanoseconds time_budget = std::chrono::seconds(5);
  Mode mode = Mode::first;
  Objective objective = Objective::flowtime;  // minimized by `anytime`
  std::uint64_t seed = 0;                     // seed of all random choices
  /// The order in which robots are planned first. Later robots give way to earlier ones.
  Priority priority = Priority::shortest_first;
  /// How the order changes when no plan is found for a robot.
  Reordering reordering = Reordering::raise_failed;
  /// Seconds, >= 0: how long a start is kept free until its robot is planned. None: 3 seconds, unless any
  /// robot has committed actions or a previous plan. With these, 0, or 1 with a horizon.
  std::optional<double> start_safe_interval = {};
  /// Metres, >= 0, added to every radius during planning: a margin for real robots.
  double inflation = 0.0;
  /// Seconds, >= 0: how long a robot stands still before every translation, already turned.
  double wait_before_move = 0.0;
  /// Allows straight moves between any two cells in line of sight. Otherwise, moves lead to neighbours only.
  bool any_angle = true;
  /// Lets robots stop off the lattice where that makes paths shorter. Requires `any_angle`, and no horizon.
  bool smoothing = true;
  int connectivity = 8;  // the number of neighbours of a cell: 4, 8, 16 or 32
  Replan replan = Replan::all;
  /// Seconds, >= 0: any two robots may be so much early or late without a collision.
  double interval_margin = 0.0;
  /// Metres, >= 0: how far measured starts may overlap each other or a wall, inflation included.
  double start_overlap = 0.0;
  /// Metres, >= 0: how far a robot may overlap a wall at its last goal, inflation included. This is for
  /// docks, where robots stay. The next plan starts there, so starts may overlap a wall as far.
  double goal_overlap = 0.0;
  /// Metres between the points of the lattice. Robots may stop there, and at starts and goals. None: the
  /// planner chooses it by the map and the robot's radius.
  std::optional<double> lattice_spacing = {};
  /// Seconds: conflicts are resolved up to this time. A plan may then stop before its goal, where the robot
  /// may rest for good; see RobotPlan::estimated_cost. None: the whole way is planned.
  std::optional<double> horizon = {};
  InvalidRobots invalid_robots = InvalidRobots::refuse;
  /// The number of steps that improve the plan in mode `anytime`. None: until the time budget ends.
  std::optional<std::int64_t> max_iterations = {};
};

}  // namespace fleetplan
