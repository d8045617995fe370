// SPDX-License-Identifier: Apache-2.0
// Packs the colour of traced bands on the device, so that less is read back.
#pragma once

#include <map>
#include <memory>
#include <mutex>

#include "display/color_form.h"
#include "gpu/buffer.h"
#include "gpu/commands.h"
#include "gpu/compute_pass.h"

namespace viewloom {

// The device must outlive it. Thread-safety: all methods may be called from any thread.
class BandPacker {
 public:
  explicit BandPacker(const Device& device) : device_(&device) {}

  // From R, G, B, ignored, uint32_t[row][width], to the planes of YcbcrLayout. Waits for the
  // compute work before it. The first band of a form compiles its pipeline.
  void record(Commands commands, const Buffer& rgba, const Buffer& planes, SizePx size_px,
              ColorForm form);

 private:
  const ComputePass& pass(ColorForm form);

  const Device* device_;
  std::mutex mutex_;  // guards passes_
  std::map<ColorForm, std::unique_ptr<ComputePass>> passes_;
};

}  // namespace viewloom
