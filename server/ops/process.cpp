#include "server/ops/process.h"

#include <fcntl.h>
#include <malloc.h>
#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <system_error>
#include <thread>

namespace fleetplan::server {

void open_standard_descriptors() {
  for (int fd = STDIN_FILENO; fd <= STDERR_FILENO; ++fd) {
    if (::fcntl(fd, F_GETFD) >= 0 || errno != EBADF) continue;
    ::open("/dev/null", O_RDWR);  // gets the lowest free number, which is `fd`
  }
}

// The allocator's defaults let resident memory creep for hours under mixed load, for two reasons:
//
// - It would have eight arenas for each CPU, each with the peaks of the connections that happened to meet
//   there.
// - Blocks from a certain size on are given back at once. It raises this size to the size of the largest
//   block freed so far.
//
// The size is fixed here. It is large enough for the planner's tables to stay, which come and go with each
// robot.
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
  return static_cast<double>(std::distance(begin(fds), end(fds))) - 1.0;  // without the listing's own
                                                                          // descriptor
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

namespace fs = std::filesystem;

namespace {

int cpus_by_affinity() {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof set, &set) == 0) return CPU_COUNT(&set);
  return static_cast<int>(std::thread::hardware_concurrency());  // more processors than the set holds
}

std::string first_line(const fs::path& file) {
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  return line;
}

/// Reads the quota of a cgroup v2 `cpu.max`: "150000 100000" is 1.5 processors; none for "max ...".
std::optional<double> parse_quota(const std::string& text) {
  std::istringstream fields(text);
  double quota = 0.0;
  double period = 0.0;
  if (!(fields >> quota >> period) || quota <= 0.0 || period <= 0.0) return std::nullopt;
  return quota / period;
}

std::optional<double> quota_v2(const fs::path& group) { return parse_quota(first_line(group / "cpu.max")); }

std::optional<double> quota_v1(const fs::path& group) {
  return parse_quota(first_line(group / "cpu.cfs_quota_us") + ' ' + first_line(group / "cpu.cfs_period_us"));
}

/// Returns the smallest quota of a group and the groups above it. Inside a container, the group's own path
/// may be absent, and its files at the mount itself. So the mount is examined last.
template <typename Quota>
std::optional<double> smallest_quota(const fs::path& mount, const fs::path& group, Quota quota) {
  std::optional<double> smallest;
  fs::path current = group.relative_path();
  while (true) {
    if (const auto here = quota(mount / current)) smallest = std::min(smallest.value_or(*here), *here);
    if (current.empty()) return smallest;
    current = current.parent_path();
  }
}

/// Returns where the v1 controllers of a line are mounted: `cpu` is a link where several are mounted
/// together, but not everywhere.
fs::path mount_v1(const fs::path& mounts, const std::string& controllers) {
  std::error_code ignored;
  return fs::is_directory(mounts / "cpu", ignored) ? mounts / "cpu" : mounts / controllers;
}

/// Returns the quota of the group that a line `id:controllers:path` names; v2 has no controllers in it.
std::optional<double> quota_of_line(const std::string& line, const fs::path& mounts) {
  std::istringstream fields(line);
  std::string id;
  std::string controllers;
  std::string path;
  std::getline(fields, id, ':');
  std::getline(fields, controllers, ':');
  std::getline(fields, path);
  if (controllers.empty()) return smallest_quota(mounts, path, quota_v2);
  const bool cpu = ("," + controllers + ",").find(",cpu,") != std::string::npos;
  return cpu ? smallest_quota(mount_v1(mounts, controllers), path, quota_v1) : std::nullopt;
}

}  // namespace

std::optional<double> cpu_quota(std::istream& membership, const fs::path& mounts) {
  std::optional<double> smallest;
  for (std::string line; std::getline(membership, line);) {
    if (const auto quota = quota_of_line(line, mounts))
      smallest = std::min(smallest.value_or(*quota), *quota);
  }
  return smallest;
}

int cpus_granted() {
  std::ifstream membership("/proc/self/cgroup");
  const double granted = cpus_by_affinity();
  const double quota = cpu_quota(membership, "/sys/fs/cgroup").value_or(granted);
  return std::max(1, static_cast<int>(std::min(granted, quota)));
}

}  // namespace fleetplan::server
