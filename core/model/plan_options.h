#pragma once

#include <cstdint>
#include <optional>

namespace fleetplan::core {

/// The options of the planner; the defaults equal those of the API.
struct PlanOptions {
  enum class Mode { first, anytime };
  enum class Objective { flowtime, makespan };
  enum class Priority { shortest_first, longest_first, as_listed, random };
  enum class Reordering { raise_failed, random, none };

  Mode mode = Mode::first;
  Objective objective = Objective::flowtime;
  std::uint64_t seed = 0;
  Priority priority = Priority::shortest_first;
  Reordering reordering = Reordering::raise_failed;
  double start_safe_interval = 3.0;  // seconds, >= 0
  double inflation = 0.0;            // metres added to every radius, >= 0
  double wait_before_move = 0.0;     // seconds, >= 0
  bool any_angle = true;
  int connectivity = 8;                        // 4, 8, 16 or 32
  std::optional<std::int64_t> max_iterations;  // of `anytime`; nullopt: until the stop condition is met
};

}  // namespace fleetplan::core
