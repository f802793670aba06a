#pragma once

#include <cstddef>
#include <string>

#include "tests/bench/measurement.h"

namespace fleetplan::bench {

/// How requests are run.
struct MeasureOptions {
  double budget = 60.0;  // seconds; the paper's limit
  int repeats = 1;
  bool alone = false;  // also plan each robot alone
};

/// Runs a body of POST /v1/plan in this thread as a worker of the service does (parse, plan, verify, write),
/// and measures the wall time. Then checks the written answer against the request. The budget comes from the
/// body; `options.budget` is only its limit. Returns the median of the times and the maximum of the memory.
Measurement measure(const std::string& name, std::size_t robots, const std::string& body,
                    const MeasureOptions& options);

}  // namespace fleetplan::bench
