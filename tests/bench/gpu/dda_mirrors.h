// SPDX-License-Identifier: Apache-2.0
// Reflected rays that march from px to px, in place of viewloom's walk (shaders/dda_mirrors.comp).
#pragma once

#include "bench/gpu/shaders/rival_abi.h"
#include "gpu/commands.h"
#include "trace/albedos.h"
#include "trace/mirror_pass.h"

namespace viewloom::bench {

struct MarchOptions {
  uint32_t stride_px = 1;
  uint32_t layer_count = 1;  // of the source, from the nearest on
  uint32_t step_count_max = 1 << 16;
  double thickness_m = 0;  // of a sample
};

// The device must outlive it. Thread-safety: none.
class DdaMirrors {
 public:
  explicit DdaMirrors(const Device& device);

  // The same as MirrorPass::record, for rows whose structure reads by bindings, with opaque colour
  // of the depth's size in 8 bits.
  void record(Commands commands, const ReflectedRows& rows, const MarchOptions& options);

 private:
  Albedos albedos_;
  ComputePass march_;
};

}  // namespace viewloom::bench
