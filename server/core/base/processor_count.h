// SPDX-License-Identifier: Apache-2.0
// How many processors this process may keep busy.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace viewloom {

struct Processors {
  uint32_t allowed_count = 1;   // by the affinity mask of the process; at least 1
  std::optional<double> quota;  // processor time by its cgroups, such as 1.5; none = no limit

  bool isLimited() const { return quota && *quota < allowed_count; }
  // Processors that can be busy all the time. More threads at once are stopped for a while.
  double busyMax() const { return isLimited() ? *quota : allowed_count; }
  // The same in whole threads: at least 1.
  uint32_t threadCount() const;
};

// The allowed processors, with the least quota of the cgroups (version 2 or 1) of this process and
// of those around them. `root` is where /proc and /sys are.
Processors readProcessors(const std::filesystem::path& root, uint32_t allowed_count);

// Those of this process, read at the first call. Thread-safety: may be called from any thread.
const Processors& processors();

// Threads that can compute at the same time.
inline uint32_t processorCount() {
  return processors().threadCount();
}

}  // namespace viewloom
