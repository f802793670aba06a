#pragma once

// This process and its system: its version, its descriptors, memory and processors, and what it uses of them.

#include <filesystem>
#include <istream>
#include <optional>

namespace fleetplan::server {

/// The version of this build, e.g. "0.1.0" (set by the build system).
inline constexpr const char* kVersion = FLEETPLAN_VERSION;

/// Opens the null device as each of the descriptors 0 to 2 that is closed. Otherwise a connection could get
/// that number and receive the log. Call it before anything else is opened.
void open_standard_descriptors();

/// Makes the process return unused memory to the system instead of keeping the peak of each of many threads.
/// Call it before any other thread is started.
void keep_memory_small(int workers);

/// Returns free memory between blocks in use; call it from time to time. After a burst of 300 MiB in four
/// arenas this took 24 to 42 ms of CPU time where blocks were of 1 kB and more, and up to 0.42 s where they
/// were of 100 bytes, freed in random order; the next time a tenth of that (glibc 2.36, AMD EPYC). Threads
/// that allocate from the same arena wait meanwhile.
void give_memory_back();

/// Resources that this process uses at the moment.
struct ProcessStats {
  double cpu_seconds = 0.0;     // user and system, of all threads
  double resident_bytes = 0.0;  // physical memory
  double virtual_bytes = 0.0;
  double open_fds = 0.0;
  double max_fds = 0.0;
};

ProcessStats process_stats();

/// Returns the number of processors that this process may use: the smaller of its affinity and the CPU quota
/// of its control groups (v2 or v1), rounded down, at least 1.
int cpus_granted();

/// Returns the smallest CPU quota, in processors, of the control groups that `membership` names (the lines of
/// /proc/self/cgroup) and of the groups above them, read below `mounts` (/sys/fs/cgroup). Returns none
/// when unlimited.
std::optional<double> cpu_quota(std::istream& membership, const std::filesystem::path& mounts);

}  // namespace fleetplan::server
