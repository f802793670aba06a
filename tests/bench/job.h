#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <variant>
#include <vector>

#include "tests/bench/instance.h"
#include "tests/bench/measure.h"
#include "tests/bench/workload.h"

namespace fleetplan::bench {

/// A workload to generate: a hall and its seed.
struct SeededRecipe {
  Recipe recipe;
  std::uint64_t seed = 1;
};

/// An instance to measure with several numbers of robots.
struct Job {
  std::string name;                              // the `file` of the results
  std::variant<std::string, SeededRecipe> from;  // a request file, or a workload
  std::vector<std::size_t> robots;               // the first so many each; none: all
  nlohmann::json planning;                       // options of the requests, over their own
  nlohmann::json defaults;                       // robot_defaults of the requests, over their own
  MeasureOptions measure;
};

/// Reads a job from one line of JSON:
///
///   {"name": "a", "file": "maps/a.json", "robots": [60, 120], "options": {"mode": "first"}, "budget": 60,
///   "repeats": 1}
///   {"name": "b", "workload": {"hall": "rects", "side": 64, "seed": 1, "robots": 300}, "robots": [], ...}
///
/// `budget` is in seconds; `"robot_defaults"` and `"alone": true`, which also plans each robot alone, may be
/// left out. Throws std::runtime_error for anything else.
Job parse_job(const std::string& line);

/// The instance of a job; throws std::runtime_error if it cannot be read.
Instance load(const Job& job);

}  // namespace fleetplan::bench
