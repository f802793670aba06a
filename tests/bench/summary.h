#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "tests/bench/result.h"

namespace fleetplan::bench {

/// Many runs with the same number of robots.
struct Summary {
  std::size_t robots = 0;
  std::size_t runs = 0;
  std::size_t solved = 0;
  // Seconds of all runs, those that solved nothing included.
  std::optional<double> median_seconds;
  std::optional<double> percentile_90_seconds;
  std::optional<double> largest_seconds;
  std::size_t peak_memory = 0;  // bytes, of all runs
  // Means of what was solved.
  std::optional<double> flowtime;
  std::optional<double> makespan;
  std::optional<double> flowtime_by_bound;

  double success_rate() const {
    return runs == 0 ? 0.0 : static_cast<double>(solved) / static_cast<double>(runs);
  }
};

/// A summary for every number of robots, ascending.
std::vector<Summary> summarise(const std::vector<Measurement>& runs);

}  // namespace fleetplan::bench
