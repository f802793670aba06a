#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tests/bench/lifelong/lifelong_job.h"

namespace fleetplan::bench {

/// What a running warehouse reached.
struct LifelongResult {
  std::size_t tasks = 0;       // served goals
  double robot_seconds = 0.0;  // of the simulated clock, summed over the robots
  double lone_seconds = 0.0;   // that the served tasks, and parts of others, take robots that are alone
  double moving_seconds = 0.0;
  double service_seconds = 0.0;
  std::size_t replans = 0;
  std::size_t under_way = 0;      // robots with a plan and moves ahead of them, summed over the replans
  std::size_t changed = 0;        // robots among them that got other moves
  std::size_t unplanned = 0;      // summed over the replans
  std::size_t late = 0;           // replans that took longer than their budget
  std::vector<double> latencies;  // seconds of each replan
  std::string fault;              // the first answer that is not a plan; empty if none
};

/// The names of the CSV columns, and a result as a row; each with its line's end.
std::string lifelong_csv_header();
std::string lifelong_csv_row(const LifelongJob& job, const LifelongResult& result);

}  // namespace fleetplan::bench
