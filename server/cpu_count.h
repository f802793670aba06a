#pragma once

#include <optional>
#include <string>

namespace fleetplan::server {

/// Processors this process may use: its affinity, cut by the CPU quota of its control groups (v2 or v1),
/// rounded down, at least 1.
int cpus_granted();

/// Processors by a cgroup v2 `cpu.max`, e.g. "150000 100000" is 1.5; none for "max ...".
std::optional<double> parse_cpu_max(const std::string& text);

}  // namespace fleetplan::server
