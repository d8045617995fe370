// SPDX-License-Identifier: Apache-2.0
// Makes px of bands out of several samples of each, in light.
#pragma once

#include <vector>

#include "display/ray_samples.h"
#include "gpu/buffer.h"
#include "gpu/commands.h"
#include "gpu/pass_map.h"

namespace viewloom {

// Targets of a blend: `sample` is read, `band` is written by the last of sample_count.
struct BlendTarget {
  const Buffer& sample;         // R, G, B, ignored, uint32_t per px
  const Buffer& sums;           // linear light, float[3] per px
  const Buffer& band;           // as `sample`
  uint64_t linear_address = 0;  // of TraceExtras::linear; 0 = not wanted
  uint32_t px_count = 0;
  // Px that are blended; where spans follow each other, all of them once. Those at the end may be
  // left to the next span.
  uint32_t first_px = 0;
  uint32_t end_px = 0;
};

// The device must outlive it. Thread-safety: all methods may be called from any thread.
class BlendPass {
 public:
  explicit BlendPass(const Device& device) : pass_(device, makePass) {}

  // Kernels that record() needs.
  void addMissing(MissingKernels& missing) { pass_.addMissing({}, missing); }

  // Adds sample `index` of `samples`, which come in order. Each channel is the mean of those that
  // count for it. Waits for the compute work before it, and what follows may write the next one.
  void record(Commands commands, const BlendTarget& target, const std::vector<RaySample>& samples,
              uint32_t index);

 private:
  static ComputePass makePass(const Device& device, const std::monostate&);

  SinglePass pass_;
};

}  // namespace viewloom
