#pragma once

#include <cstddef>
#include <string>

#include "tests/bench/result.h"

namespace fleetplan::bench {

/// How requests are run.
struct MeasureOptions {
  double budget = 60.0;  // seconds; the paper's limit
  int repeats = 1;
};

/// Runs a body of POST /v1/plan in this thread the way a worker of the service does (parse, plan, verify,
/// write), taking the wall time of that; then has the answer as it was written checked against the request.
/// The budget is the body's own, `options.budget` only its limit. Of the times the median counts, of the
/// memory the largest.
Measurement measure(const std::string& name, std::size_t robots, const std::string& body,
                    const MeasureOptions& options);

}  // namespace fleetplan::bench
