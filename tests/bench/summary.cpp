#include "tests/bench/summary.h"

#include <algorithm>
#include <map>

#include "tests/bench/statistics.h"

namespace fleetplan::bench {
namespace {

Summary summary_of(std::size_t robots, const std::vector<const Measurement*>& runs) {
  Summary summary;
  summary.robots = robots;
  summary.runs = runs.size();
  std::vector<double> seconds;
  std::vector<double> flowtimes;
  std::vector<double> makespans;
  std::vector<double> by_bound;
  for (const Measurement* run : runs) {
    seconds.push_back(run->result.seconds);
    summary.peak_memory = std::max(summary.peak_memory, run->peak_memory);
    if (!run->result.solved) continue;
    ++summary.solved;
    flowtimes.push_back(run->result.flowtime.value());
    makespans.push_back(run->result.makespan.value());
    if (run->lower_bound.value() > 0.0) by_bound.push_back(flowtimes.back() / *run->lower_bound);
  }
  summary.median_seconds = median(seconds);
  summary.percentile_90_seconds = percentile(seconds, 0.9);
  summary.largest_seconds = maximum(seconds);
  summary.flowtime = mean(flowtimes);
  summary.makespan = mean(makespans);
  summary.flowtime_by_bound = mean(by_bound);
  return summary;
}

}  // namespace

std::vector<Summary> summarise(const std::vector<Measurement>& runs) {
  std::map<std::size_t, std::vector<const Measurement*>> by_robots;
  for (const Measurement& run : runs) by_robots[run.result.robots].push_back(&run);
  std::vector<Summary> summaries;
  summaries.reserve(by_robots.size());
  for (const auto& [robots, same] : by_robots) summaries.push_back(summary_of(robots, same));
  return summaries;
}

}  // namespace fleetplan::bench
