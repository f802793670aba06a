#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

namespace fleetplan::core {

/// The options of the planner. The defaults equal the defaults of the API.
struct PlanOptions {
  enum class Mode { first, anytime };
  /// What is minimized:
  ///
  /// - flowtime: the sum of the robots' costs, each times the robot's weight.
  /// - makespan: the greatest cost.
  /// - tardiness: the sum of delays after `due` at goals, each times the robot's weight. Flowtime decides
  ///   ties.
  enum class Objective { flowtime, makespan, tardiness };
  enum class Priority { shortest_first, longest_first, as_listed, random };
  enum class Reordering { raise_failed, random, none };
  enum class Replan { all, where_needed };

  Mode mode = Mode::first;
  Objective objective = Objective::flowtime;
  std::uint64_t seed = 0;
  Priority priority = Priority::shortest_first;
  Reordering reordering = Reordering::raise_failed;
  double start_safe_interval = 3.0;  // seconds, >= 0
  double inflation = 0.0;            // metres added to every radius, >= 0
  double wait_before_move = 0.0;     // seconds, >= 0
  bool any_angle = true;
  /// Lets the stops of paths leave the lattice where that makes the plan better. Requires `any_angle`, and no
  /// horizon.
  bool smoothing = true;
  int connectivity = 8;  // 4, 8, 16 or 32
  /// How previous plans that hold are used. Either the search begins with them, or it changes them only where
  /// another robot has no other plan.
  Replan replan = Replan::all;
  /// Seconds, >= 0: |p_i(t) - p_j(t + d)| >= r_i + r_j for all |d| <= interval_margin.
  double interval_margin = 0.0;
  /// Metres, >= 0: how far starts may overlap each other or a wall, inflation included.
  double start_overlap = 0.0;
  /// Metres, >= 0: how far a robot may overlap a wall at its last goal, where it stays, inflation included.
  /// The robot begins its next plan there, so starts may overlap a wall as far.
  double goal_overlap = 0.0;
  /// Metres between the vertices of the lattice. nullopt: the planner chooses it by the map and the robots.
  std::optional<double> lattice_spacing = {};
  /// Seconds, > 0: conflicts are resolved up to this time. Then a robot may rest anywhere for good, with its
  /// static way before it. nullopt: whole ways are planned.
  std::optional<double> horizon = {};
  std::optional<std::int64_t> max_iterations;  // steps of `anytime`; nullopt: until the stop condition is met

  /// Metres: how far starts may overlap, by both options.
  double overlap_at_start() const { return std::max(start_overlap, goal_overlap); }
};

}  // namespace fleetplan::core
