// Simulates running warehouses: reads jobs from stdin, one line of JSON each (see lifelong_job.h), and writes
// a row of CSV to stdout for each. Progress and faults go to stderr. scripts/bench --lifelong builds and runs
// this.

#include <iostream>
#include <stdexcept>
#include <string>

#include "tests/bench/lifelong/lifelong.h"

namespace fleetplan::bench {
namespace {

void run(const LifelongJob& job) {
  constexpr double kReportEvery = 60.0;  // simulated seconds
  double reported = 0.0;
  const LifelongResult result = simulate(job, [&](double seconds, const LifelongResult& so_far) {
    if (seconds < reported + kReportEvery) return;
    reported = seconds;
    std::cerr << job.name << ", " << job.robots << " robots: " << seconds << " s, " << so_far.tasks
              << " tasks, " << so_far.replans << " plans\n";
  });
  if (!result.fault.empty()) std::cerr << "  FAULT: " << result.fault << '\n';
  std::cout << lifelong_csv_row(job, result) << std::flush;
}

}  // namespace
}  // namespace fleetplan::bench

int main() {
  using namespace fleetplan::bench;
  try {
    std::cout << lifelong_csv_header() << std::flush;
    for (std::string line; std::getline(std::cin, line);) run(parse_lifelong_job(line));
  } catch (const std::runtime_error& error) {
    std::cerr << "fleetplan_lifelong: " << error.what() << '\n';
    return 1;
  }
}
