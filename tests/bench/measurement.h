#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "tests/bench/alone.h"

namespace fleetplan::bench {

/// The result of planning an instance.
struct Measurement {
  std::string file;        // of the instance, or the name of a generated one
  std::size_t robots = 0;  // the first so many
  bool solved = false;     // every robot has a plan
  std::int64_t attempts = 0;
  double seconds = 0.0;
  std::optional<double> flowtime;  // seconds; only of solved instances, as the next three
  std::optional<double> makespan;
  std::optional<double> lower_bound;  // of the flowtime
  std::optional<double> makespan_lower_bound;
  double cpu_seconds = 0.0;     // far below `seconds` if the machine was busy
  std::size_t peak_memory = 0;  // bytes of this process, so more than the request took
  std::size_t planned = 0;      // robots with a plan
  std::int64_t expansions = 0;
  std::int64_t improvements = 0;
  bool deterministic = false;
  /// Seconds of the steps of the last run, but of planning the median; 0 if it failed.
  double parse_seconds = 0.0;
  double plan_seconds = 0.0;
  double verify_seconds = 0.0;
  double write_seconds = 0.0;
  std::optional<Alone> alone;
  std::string fault;  // what is wrong with the answer; empty if nothing is
};

}  // namespace fleetplan::bench
