#pragma once

// What people read of the results.

#include <string>
#include <vector>

#include "tests/bench/comparison.h"
#include "tests/bench/result.h"
#include "tests/bench/summary.h"

namespace fleetplan::bench {

/// One hall of the paper with its results.
struct HallSummary {
  std::string name;
  std::vector<Summary> by_robots;
};

/// What the columns of a hall's table are.
inline constexpr const char* kHallTableNotes =
    "Seconds are of all runs, parsing to writing; flowtime and makespan are means of the solved ones.\n"
    "/ bound is flowtime by its lower bound, at most what every robot would cost alone on the map.\n";

/// A table of a hall: success rate beside the paper's, times and costs against the number of robots.
std::string hall_table(const HallSummary& hall);

/// The chart of all halls: success rate, runtime, and flowtime over its lower bound.
std::string hall_chart(const std::vector<HallSummary>& halls);

/// A table with a row for each run.
std::string run_table(const std::vector<Measurement>& runs);

/// A table with a row for each run beside the reference's, and what they come to.
std::string comparison_report(const Comparison& comparison);

/// What all runs come to: how many answers were at fault, how busy the machine was, and the memory.
std::string closing_lines(const std::vector<Measurement>& runs);

}  // namespace fleetplan::bench
