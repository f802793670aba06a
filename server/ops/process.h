#pragma once

// The process and the system: its descriptors, its memory, and what it uses of both.

namespace fleetplan::server {

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

}  // namespace fleetplan::server
