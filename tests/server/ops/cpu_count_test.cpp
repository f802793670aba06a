#include <gtest/gtest.h>

#include <sstream>
#include <string>

#include "server/ops/process.h"
#include "tests/support/temporary_folder.h"

namespace fleetplan::server {
namespace TEST_FILE {

/// What the kernel mounts at /sys/fs/cgroup, made of ordinary files.
class CpuQuota : public testing::Test {
 protected:
  void write(const std::string& file, const std::string& line) const { mounts_.write(file, line + '\n'); }

  void limit_v1(const std::string& group, const std::string& quota) const {
    write(group + "/cpu.cfs_quota_us", quota);
    write(group + "/cpu.cfs_period_us", "100000");
  }

  std::optional<double> of(const std::string& membership) const {
    std::istringstream lines(membership);
    return cpu_quota(lines, mounts_.path());
  }

 private:
  support::TemporaryFolder mounts_;
};

TEST(CpuCount, IsAtLeastOne) { EXPECT_GE(cpus_granted(), 1); }

TEST_F(CpuQuota, IsNoneWithoutControlGroups) { EXPECT_EQ(of(""), std::nullopt); }

TEST_F(CpuQuota, IsReadInAContainerWithV2) {
  write("cpu.max", "150000 100000");
  EXPECT_EQ(of("0::/\n"), 1.5);
  write("cpu.max", "max 100000");
  EXPECT_EQ(of("0::/\n"), std::nullopt);
}

TEST_F(CpuQuota, IsReadInAContainerThatSeesItsPathOnTheHost) {
  write("cpu.max", "200000 100000");
  EXPECT_EQ(of("0::/system.slice/docker-1f2e.scope\n"), 2.0);
}

TEST_F(CpuQuota, IsTheSmallestOfTheGroupsAbove) {
  write("system.slice/cpu.max", "400000 100000");
  write("system.slice/fleetplan.service/cpu.max", "max 100000");
  EXPECT_EQ(of("0::/system.slice/fleetplan.service\n"), 4.0);
  write("system.slice/fleetplan.service/cpu.max", "300000 100000");
  EXPECT_EQ(of("0::/system.slice/fleetplan.service\n"), 3.0);
  write("system.slice/other.service/cpu.max", "100000 100000");
  EXPECT_EQ(of("0::/system.slice/fleetplan.service\n"), 3.0);
}

TEST_F(CpuQuota, IsReadFromTheCpuControllerWithV1) {
  limit_v1("cpu/docker/1f2e", "50000");
  limit_v1("cpu", "-1");
  limit_v1("cpuset/docker/1f2e", "10000");
  EXPECT_EQ(of("3:cpuset:/docker/1f2e\n1:cpu:/docker/1f2e\n0::/\n"), 0.5);
  EXPECT_EQ(of("1:cpu:/\n"), std::nullopt);
}

TEST_F(CpuQuota, IsReadInAContainerWithV1) {
  limit_v1("cpu", "250000");
  EXPECT_EQ(of("1:cpu,cpuacct:/docker/1f2e\n"), 2.5);
}

TEST_F(CpuQuota, IsFoundWhereV1ControllersAreMountedTogether) {
  limit_v1("cpu,cpuacct", "300000");
  EXPECT_EQ(of("4:cpu,cpuacct:/\n"), 3.0);
}

TEST_F(CpuQuota, IsNoneWhereFilesAreMissingOrBroken) {
  write("cpu.max", "");
  EXPECT_EQ(of("0::/\n"), std::nullopt);
  write("cpu.max", "100000");
  EXPECT_EQ(of("0::/\n"), std::nullopt);
  write("cpu.max", "100000 0");
  EXPECT_EQ(of("0::/\n1:cpu:/\nnonsense\n"), std::nullopt);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::server
