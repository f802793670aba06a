#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

namespace fleetplan::core {

/// The options of the planner; the defaults equal those of the API.
struct PlanOptions {
  enum class Mode { first, anytime };
  /// What is minimized: the sum of the robots' costs, each times its weight; the greatest cost; or the sum of
  /// how much later than due they arrive at goals, each times the robot's weight, ties by the first.
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
  /// Whether the stops of paths leave the lattice where that makes the plan better; with `any_angle`, and
  /// without a horizon.
  bool smoothing = true;
  int connectivity = 8;  // 4, 8, 16 or 32
  /// How previous plans that hold are used: the search begins with them, or changes them only where another
  /// robot could not be planned otherwise.
  Replan replan = Replan::all;
  /// Seconds, >= 0: |p_i(t) - p_j(t + d)| >= r_i + r_j for all |d| <= interval_margin.
  double interval_margin = 0.0;
  /// Metres, >= 0: how much starts may overlap each other or a wall, inflation included.
  double start_overlap = 0.0;
  /// Metres, >= 0: how much a robot may overlap a wall at its last goal, inflation included, where it stays.
  /// As such a robot begins there the next time, starts may overlap so much, too.
  double goal_overlap = 0.0;
  /// Metres between the vertices of the lattice; nullopt: chosen by the map and the robots.
  std::optional<double> lattice_spacing = {};
  /// Seconds, > 0: conflicts are resolved up to this time; then a robot may rest anywhere for good and has
  /// its static way before it. nullopt: whole ways are planned.
  std::optional<double> horizon = {};
  std::optional<std::int64_t> max_iterations;  // steps of `anytime`; nullopt: until the stop condition is met

  /// Metres: how much starts may overlap, by both options.
  double overlap_at_start() const { return std::max(start_overlap, goal_overlap); }
};

}  // namespace fleetplan::core
