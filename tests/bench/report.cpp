#include "tests/bench/report.h"

#include <algorithm>
#include <array>
#include <optional>
#include <sstream>
#include <utility>

#include "tests/bench/chart.h"
#include "tests/bench/markdown.h"
#include "tests/bench/paper_claims.h"

namespace fleetplan::bench {
namespace {

/// Below this share of CPU time in wall time other work has disturbed the times.
constexpr double kIdleShare = 0.95;

std::string percent(double share) { return decimal(100.0 * share, 0) + " %"; }

std::string times(const std::optional<double>& ratio) {
  return ratio ? decimal(*ratio, *ratio < 10.0 ? 2 : 1) + " x" : "-";
}

std::optional<double> by_bound(const Measurement& run) {
  if (!run.result.flowtime || !run.lower_bound || *run.lower_bound <= 0.0) return std::nullopt;
  return *run.result.flowtime / *run.lower_bound;
}

/// The colours of the first halls, the paper's two; others begin again.
constexpr std::array<const char*, 2> kColours{"#1f6fb4", "#c8501e"};

std::string colour(std::size_t hall) { return kColours[hall % kColours.size()]; }

/// A line of one number of every summary that has it.
template <class Number>
ChartLine line_of(const HallSummary& hall, const std::string& colour, Number&& number) {
  ChartLine line{hall.name, colour, false, {}};
  for (const Summary& summary : hall.by_robots) {
    const std::optional<double> y = number(summary);
    if (y) line.points.push_back({static_cast<double>(summary.robots), *y});
  }
  return line;
}

/// The paper's own success in the empty hall, as far as its text goes.
std::vector<ChartLine> paper_lines() {
  const std::string name =
      "empty, the paper's planner as far as its text says: all up to 210 robots, below 10 % from 285 on";
  const auto level = [&](std::size_t from, std::size_t to, double rate) {
    return ChartLine{name,
                     "#888888",
                     true,
                     {{static_cast<double>(from), 100.0 * rate}, {static_cast<double>(to), 100.0 * rate}}};
  };
  return {level(kFewestRobots, kAllSolvedUpTo, 1.0), level(kFewSolvedFrom, kMostRobots, kFewSolved)};
}

}  // namespace

std::string hall_table(const HallSummary& hall) {
  std::vector<TableRow> rows;
  for (const Summary& summary : hall.by_robots) {
    rows.push_back({std::to_string(summary.robots), percent(summary.success_rate()),
                    claimed_success(hall.name, summary.robots), seconds_text(summary.median_seconds),
                    seconds_text(summary.percentile_90_seconds), seconds_text(summary.largest_seconds),
                    decimal(summary.flowtime, 0), decimal(summary.flowtime_by_bound, 3),
                    decimal(summary.makespan, 1), mebibytes(summary.peak_memory)});
  }
  return markdown_table({hall.name + ": robots", "solved", "paper", "median s", "90 % s", "max s", "flowtime",
                         "/ bound", "makespan", "MiB"},
                        rows);
}

std::string hall_chart(const std::vector<HallSummary>& halls) {
  ChartPanel success{"instances solved, %", false, 0.0, {}};
  ChartPanel runtime{"seconds: median; dashed: 90 % are below", true, {}, {}};
  ChartPanel flowtime{"flowtime / lower bound, mean", false, {}, {}};
  for (std::size_t i = 0; i < halls.size(); ++i) {
    success.lines.push_back(line_of(halls[i], colour(i), [](const Summary& summary) {
      return std::optional<double>(100.0 * summary.success_rate());
    }));
    runtime.lines.push_back(
        line_of(halls[i], colour(i), [](const Summary& summary) { return summary.median_seconds; }));
    runtime.lines.push_back(
        line_of(halls[i], colour(i), [](const Summary& summary) { return summary.percentile_90_seconds; }));
    runtime.lines.back().dashed = true;
    flowtime.lines.push_back(
        line_of(halls[i], colour(i), [](const Summary& summary) { return summary.flowtime_by_bound; }));
  }
  for (ChartLine& line : paper_lines()) success.lines.push_back(std::move(line));
  return svg_chart(
      "Fleetplan on the workloads of the AA-SIPP(m) paper (64 x 64 cells, three types of robots)", "robots",
      {success, runtime, flowtime});
}

std::string run_table(const std::vector<Measurement>& runs) {
  std::vector<TableRow> rows;
  for (const Measurement& run : runs) {
    const Result& result = run.result;
    rows.push_back({result.file, std::to_string(result.robots), std::to_string(run.planned),
                    seconds_text(result.seconds), std::to_string(result.attempts),
                    std::to_string(run.expansions), mebibytes(run.peak_memory), decimal(result.flowtime, 1),
                    decimal(by_bound(run), 3), decimal(result.makespan, 1)});
  }
  return markdown_table(
      {"file", "robots", "planned", "s", "attempts", "expansions", "MiB", "flowtime", "/ bound", "makespan"},
      rows);
}

std::string comparison_report(const Comparison& comparison) {
  std::vector<TableRow> rows;
  for (const ComparedRow& row : comparison.rows) {
    const std::string theirs = row.reference.solved ? "" : " failed";
    const std::string ours = row.ours.solved ? "" : " failed";
    rows.push_back({row.ours.file, std::to_string(row.ours.robots),
                    seconds_text(row.reference.seconds) + theirs, seconds_text(row.ours.seconds) + ours,
                    times(row.speedup), decimal(row.reference.flowtime, 1), decimal(row.ours.flowtime, 1),
                    decimal(row.flowtime_ratio, 3)});
  }
  std::ostringstream text;
  text << markdown_table(
              {"file", "robots", "reference s", "s", "speed-up", "reference flowtime", "flowtime", "ratio"},
              rows)
       << "\nsolved: " << comparison.solved_by_us << " of " << comparison.rows.size() << ", the reference "
       << comparison.solved_by_reference << ", only the reference " << comparison.lost
       << "\nspeed-up where the reference took " << kShortestReference << " s or more (" << comparison.counted
       << " rows): geometric mean " << times(comparison.mean_speedup) << ", smallest "
       << times(comparison.smallest_speedup) << "\nflowtime ratio: mean "
       << decimal(comparison.mean_flowtime_ratio, 3) << ", largest "
       << decimal(comparison.largest_flowtime_ratio, 3) << "\n";
  return text.str();
}

std::string closing_lines(const std::vector<Measurement>& runs) {
  std::size_t faults = 0;
  std::size_t memory = 0;
  double wall = 0.0;
  double cpu = 0.0;
  for (const Measurement& run : runs) {
    faults += run.fault.empty() ? 0 : 1;
    memory = std::max(memory, run.peak_memory);
    wall += run.result.seconds;
    cpu += run.cpu_seconds;
  }
  std::ostringstream text;
  text << "Plans: " << runs.size() << ", all checked in continuous time; at fault: " << faults << ".\n"
       << "Peak resident memory " << mebibytes(memory) << " MiB. Wall time " << seconds_text(wall)
       << " s, CPU time " << seconds_text(cpu) << " s";
  text << (cpu < kIdleShare * wall ? ": the machine was busy, and an idle one is faster.\n" : ".\n");
  return text.str();
}

}  // namespace fleetplan::bench
