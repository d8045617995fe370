// SPDX-License-Identifier: Apache-2.0
#include "base/processor_count.h"

#include <sched.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>
#include <thread>

#include "absl/strings/numbers.h"
#include "base/cgroup_folders.h"

namespace viewloom {
namespace {

// A cgroup may take so much processor time, `quota`, in each period of the clock; both in us.
std::optional<double> quotaIn(const CgroupFolder& folder) {
  std::string quota;
  std::string period;
  if (folder.version == 2) {
    std::ifstream(folder.path / "cpu.max") >> quota >> period;
  } else {
    std::ifstream(folder.path / "cpu.cfs_quota_us") >> quota;
    std::ifstream(folder.path / "cpu.cfs_period_us") >> period;
  }
  uint64_t quota_us = 0;
  uint64_t period_us = 0;
  // "max" of version 2 and -1 of version 1 are no limit, nor is a file that is not there.
  if (!absl::SimpleAtoi(quota, &quota_us) || !absl::SimpleAtoi(period, &period_us)) return {};
  if (quota_us == 0 || period_us == 0) return {};
  return double(quota_us) / double(period_us);
}

// By the affinity mask of this process; std::thread::hardware_concurrency() of glibc leaves it out.
uint32_t allowedCount() {
  cpu_set_t allowed;
  // Fails on machines of more than 1024 processors.
  if (sched_getaffinity(0, sizeof allowed, &allowed) != 0) {
    return std::thread::hardware_concurrency();
  }
  return uint32_t(CPU_COUNT(&allowed));
}

}  // namespace

uint32_t Processors::threadCount() const {
  return std::max(1U, uint32_t(std::ceil(busyMax())));
}

Processors readProcessors(const std::filesystem::path& root, uint32_t allowed_count) {
  Processors found{.allowed_count = std::max(1U, allowed_count)};
  for (const CgroupFolder& folder : cgroupFolders(root, "cpu")) {
    const std::optional<double> quota = quotaIn(folder);
    if (quota) found.quota = std::min(*quota, found.quota.value_or(*quota));
  }
  return found;
}

const Processors& processors() {
  static const Processors own = readProcessors("/", allowedCount());
  return own;
}

}  // namespace viewloom
