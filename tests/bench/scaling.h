#pragma once

#include <functional>
#include <string>

#include "tests/bench/options.h"
#include "tests/bench/result.h"

namespace fleetplan::bench {

/// Measures one body of POST /v1/plan with so many robots under a name.
using Measure =
    std::function<Measurement(const std::string& name, std::size_t robots, const std::string& body)>;

/// Tables of time and cost against the number of robots on 64x64 cells, and against the map's size with as
/// many robots and with as many to the cell. Seeds, budget and options are those of `options`.
std::string scaling_report(const Options& options, const Measure& measure);

}  // namespace fleetplan::bench
