// SPDX-License-Identifier: Apache-2.0
// Dispatches a rival's kernel over a whole atlas, and has what it wrote.
#pragma once

#include <span>
#include <vector>

#include "bench/contestant.h"
#include "bench/gpu/shaders/rival_abi.h"
#include "gpu/compute_pass.h"
#include "gpu/submission.h"
#include "trace/trace_slot.h"

namespace viewloom::bench {

// Whether rivals can make these views: opaque colour of the depth's size, rays that all run from
// the near bound to infinity, arrays that fit the device's bindings.
bool fitsAtlasPass(const Device& device, const BenchLoad& load);

// One dispatch where the device's bindings allow that: on lavapipe the floor took 7.2 ns a ray in
// bands of 128 rows, 6.8 as a whole (2026-11-21). The device must outlive it. Thread-safety: none.
class AtlasPass {
 public:
  // `spirv`: a kernel that includes rival_views.glsl; `slots`: what it reads beside views and band.
  AtlasPass(const Device& device, const BenchLoad& load, std::span<const uint32_t> spirv,
            std::span<const DescriptorSlot> slots, const char* name);

  // Once the bindings are known. `box_stride`: abi::RivalPush.
  void bind(std::vector<Descriptor> descriptors, uint32_t box_stride = 0);
  // Colour of the whole atlas; returns when done.
  void trace() { run(color_); }
  // Colour and inv_z, traced anew.
  Picture picture();

 private:
  ComputePass makePass(std::span<const uint32_t> spirv, std::span<const DescriptorSlot> slots,
                       bool writes_inv_z, const char* name) const;
  void run(const ComputePass& pass);
  void clear();

  const Device* device_;
  const BenchLoad* load_;
  bool lanes_are_views_;
  uint32_t pixels_;
  uint32_t rows_per_dispatch_;
  abi::RivalPush push_;
  ComputePass color_;
  ComputePass inv_z_;
  std::vector<Descriptor> descriptors_;
  Buffer views_;
  ReadablePlane atlas_;
  Timeline timeline_;
  CommandRecorder recorder_;
};

}  // namespace viewloom::bench
