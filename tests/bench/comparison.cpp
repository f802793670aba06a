#include "tests/bench/comparison.h"

#include <algorithm>

#include "tests/bench/statistics.h"

namespace fleetplan::bench {

Comparison compare(const std::vector<Measurement>& ours, const std::vector<Result>& reference) {
  Comparison comparison;
  std::vector<double> speedups;
  std::vector<double> flowtime_ratios;
  for (const Measurement& measurement : ours) {
    const Result& mine = measurement.result;
    const auto other = std::find_if(reference.begin(), reference.end(), [&](const Result& result) {
      return result.file == mine.file && result.robots == mine.robots;
    });
    if (other == reference.end()) continue;
    ComparedRow row{mine, *other, {}, {}};
    comparison.solved_by_us += mine.solved ? 1 : 0;
    comparison.solved_by_reference += other->solved ? 1 : 0;
    comparison.lost += other->solved && !mine.solved ? 1 : 0;
    if (mine.solved && other->solved) {
      row.speedup = other->seconds / mine.seconds;
      row.flowtime_ratio = mine.flowtime.value() / other->flowtime.value();
      if (other->seconds >= kShortestReference) speedups.push_back(*row.speedup);
      flowtime_ratios.push_back(*row.flowtime_ratio);
    }
    comparison.rows.push_back(std::move(row));
  }
  comparison.counted = speedups.size();
  comparison.smallest_speedup = minimum(speedups);
  comparison.mean_speedup = geometric_mean(speedups);
  comparison.mean_flowtime_ratio = mean(flowtime_ratios);
  comparison.largest_flowtime_ratio = maximum(flowtime_ratios);
  return comparison;
}

}  // namespace fleetplan::bench
