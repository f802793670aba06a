#include "tests/bench/lifelong/lifelong_result.h"

#include <algorithm>

namespace fleetplan::bench {
namespace {

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
}

}  // namespace

std::string lifelong_csv_header() {
  return "name,robots,seconds,tasks,of_bound,tasks_per_hour,waiting,replans,changed,unplanned,late,median_s,"
         "p99_s,longest_s,budget_s,valid\n";
}

std::string lifelong_csv_row(const LifelongJob& job, const LifelongResult& result) {
  const double hours = result.robot_seconds / 3600.0;
  const double waiting = 1.0 - (result.moving_seconds + result.service_seconds) / result.robot_seconds;
  const double changed = result.under_way == 0
                             ? 0.0
                             : static_cast<double>(result.changed) / static_cast<double>(result.under_way);
  std::string row = "\"" + job.name + "\"," + std::to_string(job.robots);
  const auto add = [&](auto value) { row.append(1, ',').append(std::to_string(value)); };
  add(job.seconds);
  add(result.tasks);
  add(result.lone_seconds / result.robot_seconds);
  add(static_cast<double>(result.tasks) / hours);
  add(waiting);
  add(result.replans);
  add(changed);
  add(result.unplanned);
  add(result.late);
  for (const double share : {0.5, 0.99, 1.0}) add(percentile(result.latencies, share));
  add(job.budget_ms / 1000.0);
  add(result.fault.empty() ? 1 : 0);
  return row + "\n";
}

}  // namespace fleetplan::bench
