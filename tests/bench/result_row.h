#pragma once

#include <string>

#include "tests/bench/measurement.h"

namespace fleetplan::bench {

/// The names of the CSV columns, and one measurement as a row, each with its line's end. The first seven
/// columns are the same as in the results of any planner.
std::string csv_header();
std::string csv_row(const Measurement& measurement);

}  // namespace fleetplan::bench
