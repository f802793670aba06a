#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "tests/bench/result.h"

namespace fleetplan::bench {

/// Speed-ups count only where the reference took at least so long (seconds): below, its process start and the
/// clock weigh too much.
inline constexpr double kShortestReference = 0.2;

/// A run beside the reference's on the same instance.
struct ComparedRow {
  Result ours;
  Result reference;
  std::optional<double> speedup;         // reference's seconds by ours, both solved
  std::optional<double> flowtime_ratio;  // ours by the reference's, both solved; below 1 is better
};

struct Comparison {
  std::vector<ComparedRow> rows;  // in the order of ours, those that the reference has
  std::size_t solved_by_us = 0;
  std::size_t solved_by_reference = 0;
  std::size_t lost = 0;                    // solved by the reference alone
  std::size_t counted = 0;                 // rows with a speed-up where the reference took kShortestReference
  std::optional<double> smallest_speedup;  // of those counted, and below as well
  std::optional<double> mean_speedup;      // geometric
  std::optional<double> mean_flowtime_ratio;
  std::optional<double> largest_flowtime_ratio;
};

/// Puts results beside the reference's of the same file and number of robots.
Comparison compare(const std::vector<Measurement>& ours, const std::vector<Result>& reference);

}  // namespace fleetplan::bench
