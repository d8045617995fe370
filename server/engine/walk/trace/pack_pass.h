// SPDX-License-Identifier: Apache-2.0
// Packs the colour of traced bands on the device, so that less is read back.
#pragma once

#include "display/color_form.h"
#include "gpu/buffer.h"
#include "gpu/commands.h"
#include "gpu/pass_map.h"

namespace viewloom {

// The device must outlive it. Thread-safety: all methods may be called from any thread.
class PackPass {
 public:
  explicit PackPass(const Device& device) : passes_(device, makePass) {}

  // Kernels that record() needs.
  void addMissing(ColorForm form, MissingKernels& missing) { passes_.addMissing(form, missing); }

  // From R, G, B, ignored, uint32_t[row][width], to the planes of YcbcrLayout. Waits for the
  // compute work before it.
  void record(Commands commands, const Buffer& rgba, const Buffer& planes, SizePx size_px,
              ColorForm form);

 private:
  static ComputePass makePass(const Device& device, const ColorForm& form);

  PassMap<ColorForm> passes_;
};

}  // namespace viewloom
