// SPDX-License-Identifier: Apache-2.0
#include "base/processor_count.h"

#include <gtest/gtest.h>
#include <sched.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace viewloom::processor_count_test {
namespace {

namespace fs = std::filesystem;

constexpr uint32_t kAllowedCount = 16;

class ProcessorCount : public testing::Test {
 protected:
  ProcessorCount() { fs::remove_all(root_); }
  ~ProcessorCount() override { fs::remove_all(root_); }

  void write(const std::string& path, const std::string& text) const {
    fs::create_directories((root_ / path).parent_path());
    std::ofstream(root_ / path) << text;
  }
  void writeQuota1(const std::string& folder, const std::string& quota_us) const {
    write(folder + "/cpu.cfs_quota_us", quota_us + "\n");
    write(folder + "/cpu.cfs_period_us", "100000\n");
  }
  Processors read() const { return readProcessors(root_, kAllowedCount); }

  const fs::path root_ =
      fs::path(testing::TempDir()) / ("viewloom_processor_count_" + std::to_string(getpid()));
};

TEST_F(ProcessorCount, isThatOfTheAffinityMaskWithoutACgroup) {
  EXPECT_FALSE(read().quota.has_value());
  EXPECT_FALSE(read().isLimited());
  EXPECT_EQ(read().busyMax(), 16);
  EXPECT_EQ(read().threadCount(), 16u);
}

TEST_F(ProcessorCount, isOneWhereTheSystemDoesNotSay) {
  EXPECT_EQ(readProcessors(root_, 0).threadCount(), 1u);
}

TEST_F(ProcessorCount, isTheQuotaRoundedUp) {
  write("proc/self/cgroup", "0::/viewloomd.service\n");
  write("sys/fs/cgroup/viewloomd.service/cpu.max", "150000 100000\n");
  EXPECT_TRUE(read().isLimited());
  EXPECT_EQ(read().busyMax(), 1.5);
  EXPECT_EQ(read().threadCount(), 2u);
  write("sys/fs/cgroup/viewloomd.service/cpu.max", "60000 20000\n");
  EXPECT_EQ(read().busyMax(), 3);
  EXPECT_EQ(read().threadCount(), 3u);
  write("sys/fs/cgroup/viewloomd.service/cpu.max", "5000 100000\n");
  EXPECT_EQ(read().busyMax(), 0.05);
  EXPECT_EQ(read().threadCount(), 1u);
}

TEST_F(ProcessorCount, isTheLeastQuotaOfTheCgroupsAround) {
  write("proc/self/cgroup", "0::/a.slice/b.slice/viewloomd.service\n");
  write("sys/fs/cgroup/a.slice/b.slice/viewloomd.service/cpu.max", "max 100000\n");
  EXPECT_FALSE(read().quota.has_value());
  write("sys/fs/cgroup/a.slice/cpu.max", "200000 100000\n");
  EXPECT_EQ(read().busyMax(), 2);
  write("sys/fs/cgroup/a.slice/b.slice/cpu.max", "400000 100000\n");
  EXPECT_EQ(read().busyMax(), 2);
  write("sys/fs/cgroup/a.slice/b.slice/viewloomd.service/cpu.max", "100000 100000\n");
  EXPECT_EQ(read().busyMax(), 1);
}

TEST_F(ProcessorCount, isNotMoreThanTheAffinityMaskAllows) {
  write("proc/self/cgroup", "0::/\n");
  write("sys/fs/cgroup/cpu.max", "3200000 100000\n");
  EXPECT_EQ(read().quota, 32);
  EXPECT_FALSE(read().isLimited());
  EXPECT_EQ(read().threadCount(), 16u);
}

TEST_F(ProcessorCount, readsQuotasOfVersion1) {
  write("proc/self/cgroup", "5:cpuset:/\n4:cpu,cpuacct:/lab/server\n1:name=systemd:/\n0::/\n");
  writeQuota1("sys/fs/cgroup/cpu", "-1");
  writeQuota1("sys/fs/cgroup/cpu/lab/server", "-1");
  EXPECT_FALSE(read().quota.has_value());
  writeQuota1("sys/fs/cgroup/cpu/lab", "250000");
  EXPECT_EQ(read().busyMax(), 2.5);
  EXPECT_EQ(read().threadCount(), 3u);
  writeQuota1("sys/fs/cgroup/cpu,cpuacct/lab/server", "50000");
  EXPECT_EQ(read().busyMax(), 0.5) << "without a link of the name cpu";
}

TEST_F(ProcessorCount, isThatOfAContainerWhosePathIsOfTheHost) {
  write("proc/self/cgroup", "12:memory:/docker/ab12\n3:cpu,cpuacct:/docker/ab12\n");
  writeQuota1("sys/fs/cgroup/cpu,cpuacct", "400000");
  writeQuota1("sys/fs/cgroup/memory", "100000");
  EXPECT_EQ(read().busyMax(), 4);
}

TEST_F(ProcessorCount, takesNoQuotaOfAnotherControllerOrGroup) {
  write("proc/self/cgroup", "5:cpuset,cpuacct:/lab\n0::/../beside\n");
  writeQuota1("sys/fs/cgroup/cpu/lab", "100000");
  write("sys/fs/cgroup/beside/cpu.max", "100000 100000\n");
  write("sys/fs/beside/cpu.max", "100000 100000\n");
  EXPECT_FALSE(read().quota.has_value());
}

TEST_F(ProcessorCount, ignoresWhatIsNoQuota) {
  write("proc/self/cgroup", "nonsense\n0:\n\n0::/lab\n3:cpu:/old\n");
  for (const char* quota : {"", "soon 100000", "100000", "0 100000", "100000 0", "-1 100000",
                            "100000x 100000", "99999999999999999999 100000"}) {
    write("sys/fs/cgroup/lab/cpu.max", quota);
    EXPECT_FALSE(read().quota.has_value()) << quota;
  }
  write("sys/fs/cgroup/cpu/old/cpu.cfs_quota_us", "100000\n");
  EXPECT_FALSE(read().quota.has_value()) << "there is no period";
}

TEST(OwnProcessors, areNoMoreThanThisProcessMayRunOn) {
  cpu_set_t mask;
  CPU_ZERO(&mask);
  ASSERT_EQ(sched_getaffinity(0, sizeof mask, &mask), 0);
  EXPECT_EQ(processors().allowed_count, uint32_t(CPU_COUNT(&mask)));
  EXPECT_GE(processorCount(), 1u);
  EXPECT_LE(processorCount(), processors().allowed_count);
}

}  // namespace
}  // namespace viewloom::processor_count_test
