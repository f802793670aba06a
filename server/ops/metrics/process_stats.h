#pragma once

namespace fleetplan::server {

/// What this process uses of the machine, as of now.
struct ProcessStats {
  double cpu_seconds = 0.0;     // user and system, of all threads
  double resident_bytes = 0.0;  // physical memory
  double virtual_bytes = 0.0;
  double open_fds = 0.0;
  double max_fds = 0.0;
};

ProcessStats process_stats();

}  // namespace fleetplan::server
