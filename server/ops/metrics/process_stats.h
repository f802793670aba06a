#pragma once

namespace fleetplan::server {

/// Resources that this process uses at the moment.
struct ProcessStats {
  double cpu_seconds = 0.0;     // user and system, of all threads
  double resident_bytes = 0.0;  // physical memory
  double virtual_bytes = 0.0;
  double open_fds = 0.0;
  double max_fds = 0.0;
};

ProcessStats process_stats();

}  // namespace fleetplan::server
