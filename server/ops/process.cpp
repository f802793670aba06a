#include "server/ops/process.h"

#include <fcntl.h>
#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

namespace fleetplan::server {

void open_standard_descriptors() {
  for (int fd = STDIN_FILENO; fd <= STDERR_FILENO; ++fd) {
    if (::fcntl(fd, F_GETFD) >= 0 || errno != EBADF) continue;
    ::open("/dev/null", O_RDWR);  // gets the lowest free number, which is `fd`
  }
}

// The allocator's defaults let resident memory creep for hours under mixed load: it would have eight arenas
// for each CPU, each with the peaks of the connections that happened to meet there, and it raises the size
// from which blocks are given back at once to that of the largest block freed so far. Fixed, the size is
// large enough for the planner's tables to stay, which come and go with each robot.
void keep_memory_small(int workers) {
#ifdef __GLIBC__
  constexpr int kGivenBackAtOnce = 4 << 20;  // bytes
  mallopt(M_ARENA_MAX, workers + 2);
  mallopt(M_MMAP_THRESHOLD, kGivenBackAtOnce);
  mallopt(M_TRIM_THRESHOLD, 2 * kGivenBackAtOnce);
#else
  static_cast<void>(workers);
#endif
}

void give_memory_back() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

namespace {

double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) * 1e-6;
}

double count_open_fds() {
  std::error_code error;
  const std::filesystem::directory_iterator fds("/proc/self/fd", error);
  if (error) return 0.0;
  return static_cast<double>(std::distance(begin(fds), end(fds))) - 1.0;  // less that of the listing
}

}  // namespace

ProcessStats process_stats() {
  ProcessStats stats;
  rusage usage{};
  if (::getrusage(RUSAGE_SELF, &usage) == 0) {
    stats.cpu_seconds = seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
  }
  double total_pages = 0.0;
  double resident_pages = 0.0;
  if (std::ifstream("/proc/self/statm") >> total_pages >> resident_pages) {
    const auto page = static_cast<double>(::sysconf(_SC_PAGESIZE));
    stats.virtual_bytes = total_pages * page;
    stats.resident_bytes = resident_pages * page;
  }
  stats.open_fds = count_open_fds();
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) == 0) stats.max_fds = static_cast<double>(limit.rlim_cur);
  return stats;
}

}  // namespace fleetplan::server
