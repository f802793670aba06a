#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace fleetplan::bench {

/// What any planner did on an instance: the columns that results have in common.
struct Result {
  std::string file;        // of the instance, or the name of a generated one
  std::size_t robots = 0;  // the first so many
  bool solved = false;     // every robot has a plan
  std::int64_t attempts = 0;
  double seconds = 0.0;
  std::optional<double> flowtime;  // seconds; of solved ones only, and below as well
  std::optional<double> makespan;
};

/// What Fleetplan did.
struct Measurement {
  Result result;
  double cpu_seconds = 0.0;           // of the same; far below when the machine was busy
  std::size_t peak_memory = 0;        // bytes of this process, so above what the request took
  std::size_t planned = 0;            // robots with a plan
  std::optional<double> lower_bound;  // of the flowtime
  std::int64_t expansions = 0;
  std::int64_t improvements = 0;
  bool deterministic = false;
  std::string fault;  // what is wrong with the answer; empty when nothing is
};

}  // namespace fleetplan::bench
