// Measures the planner: reads jobs from stdin, one line of JSON each (see job.h), and writes a row of CSV to
// stdout for every run. Progress and faults go to stderr. scripts/bench builds and runs this.

#include <iostream>
#include <stdexcept>
#include <string>

#include "tests/bench/job.h"
#include "tests/bench/measure.h"
#include "tests/bench/result_row.h"

namespace fleetplan::bench {
namespace {

void run(const Job& job) {
  const Instance instance = load(job);
  std::vector<std::size_t> counts = job.robots;
  if (counts.empty()) counts.push_back(instance.robots());
  for (const std::size_t robots : counts) {
    if (robots > instance.robots()) {
      std::cerr << job.name << " has only " << instance.robots() << " robots, not " << robots << '\n';
      continue;
    }
    const Measurement made =
        measure(job.name, robots, instance.body(robots, job.planning, job.defaults), job.measure);
    std::cerr << job.name << ", " << robots << " robots: " << made.seconds << " s, " << made.planned
              << " planned\n";
    if (!made.fault.empty()) std::cerr << "  FAULT: " << made.fault << '\n';
    std::cout << csv_row(made) << std::flush;
  }
}

}  // namespace
}  // namespace fleetplan::bench

int main() {
  using namespace fleetplan::bench;
  try {
    std::cout << csv_header() << std::flush;
    for (std::string line; std::getline(std::cin, line);) run(parse_job(line));
  } catch (const std::runtime_error& error) {
    std::cerr << "fleetplan_bench: " << error.what() << '\n';
    return 1;
  }
}
