// SPDX-License-Identifier: Apache-2.0
// How long each named pass of a submission took on the device.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gpu/commands.h"
#include "gpu/device.h"

namespace viewloom {

struct GpuPassTime {
  const char* name = "";  // a literal
  int64_t duration_ns = 0;
};

// Belongs to one slot. Without timestamps on the device it records nothing and results() is empty.
// The device must outlive it. Thread-safety: none; one thread at a time.
class GpuTimer {
 public:
  GpuTimer(const Device& device, uint32_t pass_count_max);

  // Once, at the start of a recording.
  void recordReset(Commands commands);
  // Around each pass; passes do not nest. Those over pass_count_max go untimed.
  void recordBegin(Commands commands, const char* name);
  void recordEnd(Commands commands);

  // In recording order; valid until the next recordReset. Call once the submission is done.
  std::span<const GpuPassTime> results();

 private:
  Hidden<vk::raii::QueryPool> pool_;
  double period_ns_;
  uint64_t tick_mask_ = 0;  // the bits of a timestamp that count
  uint32_t pass_count_max_;
  uint32_t query_count_ = 0;  // two per pass
  std::vector<GpuPassTime> passes_;
  std::vector<uint64_t> ticks_;
};

}  // namespace viewloom
