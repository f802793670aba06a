#include "server/cpu_count.h"

#include <sched.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string_view>
#include <thread>

namespace fleetplan::server {

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

std::optional<double> quota_v2(const fs::path& group) { return parse_cpu_max(first_line(group / "cpu.max")); }

std::optional<double> quota_v1(const fs::path& group) {
  const std::string quota = first_line(group / "cpu.cfs_quota_us");
  if (quota.empty() || quota.front() == '-') return std::nullopt;
  return parse_cpu_max(quota + " " + first_line(group / "cpu.cfs_period_us"));
}

/// The smallest quota of a group and the groups above it. Inside a container the group's own path may be
/// absent and its files be at the mount itself, which is the last one looked at.
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

std::optional<double> quota_of_line(const std::string& line) {
  std::istringstream fields(line);
  std::string id;
  std::string controllers;
  std::string path;
  std::getline(fields, id, ':');
  std::getline(fields, controllers, ':');
  std::getline(fields, path);
  if (controllers.empty()) return smallest_quota("/sys/fs/cgroup", path, quota_v2);
  const bool cpu = ("," + controllers + ",").find(",cpu,") != std::string::npos;
  return cpu ? smallest_quota("/sys/fs/cgroup/cpu", path, quota_v1) : std::nullopt;
}

}  // namespace

std::optional<double> parse_cpu_max(const std::string& text) {
  std::istringstream fields(text);
  double quota = 0.0;
  double period = 0.0;
  if (!(fields >> quota >> period) || quota <= 0.0 || period <= 0.0) return std::nullopt;
  return quota / period;
}

int cpus_granted() {
  double cpus = cpus_by_affinity();
  std::ifstream groups("/proc/self/cgroup");
  for (std::string line; std::getline(groups, line);) {
    if (const auto quota = quota_of_line(line)) cpus = std::min(cpus, *quota);
  }
  return std::max(1, static_cast<int>(cpus));
}

}  // namespace fleetplan::server
