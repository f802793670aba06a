#pragma once

// Results as CSV, one row a run. The first columns are those that results of any planner have, and reading
// wants no more, so what is written here can be read as the reference of a later run.

#include <iosfwd>
#include <string>
#include <vector>

#include "tests/bench/result.h"

namespace fleetplan::bench {

/// The columns' names, and a row; each with its line's end.
std::string csv_header();
std::string csv_row(const Measurement& measurement);

/// Reads results by the names of their columns, in any order: file, robots, solved, attempts, seconds,
/// flowtime and makespan; others are passed over. The last two are empty where nothing was solved. Throws
/// std::runtime_error with the line's number for what is missing or no number. Values hold no commas.
std::vector<Result> read_results(std::istream& csv);

}  // namespace fleetplan::bench
