// SPDX-License-Identifier: Apache-2.0
#include "admission/machine_memory.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace viewloom::machine_memory_test {
namespace {

namespace fs = std::filesystem;

class MachineMemory : public testing::Test {
 protected:
  MachineMemory() { fs::remove_all(root_); }
  ~MachineMemory() override { fs::remove_all(root_); }

  void write(const std::string& path, const std::string& text) const {
    fs::create_directories((root_ / path).parent_path());
    std::ofstream(root_ / path) << text;
  }

  const fs::path root_ =
      fs::path(testing::TempDir()) / ("viewloom_machine_memory_" + std::to_string(getpid()));
};

constexpr const char* kMemory = "MemFree:  1 kB\nMemTotal:       4194304 kB\nBuffers: 7 kB\n";
constexpr uint64_t kGiB = uint64_t{1} << 30;

TEST_F(MachineMemory, isThatOfTheMachineWithoutACgroup) {
  write("proc/meminfo", kMemory);
  EXPECT_EQ(machineMemoryBytes(root_), 4 * kGiB);
}

TEST_F(MachineMemory, isUnknownWhereTheSystemDoesNotSay) {
  EXPECT_EQ(machineMemoryBytes(root_), 0u);
}

TEST_F(MachineMemory, isTheLeastLimitOfTheCgroupsAround) {
  write("proc/meminfo", kMemory);
  write("proc/self/cgroup", "0::/system.slice/viewloomd.service\n");
  write("sys/fs/cgroup/system.slice/viewloomd.service/memory.max", "max\n");
  EXPECT_EQ(machineMemoryBytes(root_), 4 * kGiB);
  write("sys/fs/cgroup/system.slice/memory.max", "2147483648\n");
  EXPECT_EQ(machineMemoryBytes(root_), 2 * kGiB);
  write("sys/fs/cgroup/system.slice/viewloomd.service/memory.max", "1073741824\n");
  EXPECT_EQ(machineMemoryBytes(root_), kGiB);
}

TEST_F(MachineMemory, isThatOfAContainerWhosePathIsOfTheHost) {
  write("proc/meminfo", kMemory);
  write("proc/self/cgroup", "12:memory:/docker/ab12\n3:cpu,cpuacct:/docker/ab12\n");
  write("sys/fs/cgroup/memory/memory.limit_in_bytes", "1073741824\n");
  EXPECT_EQ(machineMemoryBytes(root_), kGiB);
}

TEST_F(MachineMemory, readsNamedGroupsOfVersion1) {
  write("proc/meminfo", kMemory);
  write("proc/self/cgroup", "4:blkio,memory:/lab\n0::/\n");
  write("sys/fs/cgroup/memory/memory.limit_in_bytes", "9223372036854771712\n");
  write("sys/fs/cgroup/memory/lab/memory.limit_in_bytes", "536870912\n");
  EXPECT_EQ(machineMemoryBytes(root_), kGiB / 2);
}

TEST_F(MachineMemory, takesNoLimitOfAGroupThatCannotBeSeen) {
  write("proc/meminfo", kMemory);
  write("proc/self/cgroup", "0::/../beside\n");
  write("sys/fs/cgroup/memory.max", "max\n");
  write("sys/fs/beside/memory.max", "1073741824\n");
  EXPECT_EQ(machineMemoryBytes(root_), 4 * kGiB);
}

TEST_F(MachineMemory, ignoresWhatIsNoNumber) {
  write("proc/meminfo", "MemTotal: much\n");
  write("proc/self/cgroup", "nonsense\n0:\n0::/../../x\n");
  write("sys/fs/cgroup/memory.max", "soon\n");
  EXPECT_EQ(machineMemoryBytes(root_), 0u);
}

TEST(ResidentBytes, isAtLeastAMegabyte) {
  EXPECT_GT(residentBytes(), uint64_t{1} << 20);
}

}  // namespace
}  // namespace viewloom::machine_memory_test
