#pragma once

#include <filesystem>
#include <istream>
#include <optional>

namespace fleetplan::server {

/// Returns the number of processors that this process may use: the smaller of its affinity and the CPU quota
/// of its control groups (v2 or v1), rounded down, at least 1.
int cpus_granted();

/// Returns the smallest CPU quota, in processors, of the control groups that `membership` names (the lines of
/// /proc/self/cgroup) and of the groups above them, read below `mounts` (/sys/fs/cgroup). None when
/// unlimited.
std::optional<double> cpu_quota(std::istream& membership, const std::filesystem::path& mounts);

}  // namespace fleetplan::server
