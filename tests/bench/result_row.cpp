#include "tests/bench/result_row.h"

#include <optional>
#include <sstream>

namespace fleetplan::bench {
namespace {

std::string text(const std::optional<double>& value) {
  if (!value) return {};
  std::ostringstream made;
  made.precision(9);
  made << *value;
  return made.str();
}

}  // namespace

std::string csv_header() {
  return "file,robots,solved,attempts,seconds,flowtime,makespan,cpu_seconds,peak_memory,planned,lower_bound,"
         "makespan_lower_bound,expansions,improvements,parse_seconds,plan_seconds,verify_seconds,"
         "write_seconds,alone_seconds,floor_share,deterministic,valid\n";
}

std::string csv_row(const Measurement& run) {
  std::optional<double> alone_seconds;
  std::optional<double> floor_share;
  if (run.alone) {
    alone_seconds = run.alone->seconds;
    floor_share = run.alone->floor_share;
  }
  std::ostringstream row;
  row << run.file << ',' << run.robots << ',' << run.solved << ',' << run.attempts << ',' << text(run.seconds)
      << ',' << text(run.flowtime) << ',' << text(run.makespan) << ',' << text(run.cpu_seconds) << ','
      << run.peak_memory << ',' << run.planned << ',' << text(run.lower_bound) << ','
      << text(run.makespan_lower_bound) << ',' << run.expansions << ',' << run.improvements << ','
      << text(run.parse_seconds) << ',' << text(run.plan_seconds) << ',' << text(run.verify_seconds) << ','
      << text(run.write_seconds) << ',' << text(alone_seconds) << ',' << text(floor_share) << ','
      << run.deterministic << ',' << run.fault.empty() << '\n';
  return row.str();
}

}  // namespace fleetplan::bench
