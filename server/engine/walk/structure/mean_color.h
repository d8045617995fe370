// SPDX-License-Identifier: Apache-2.0
// Colour planes of a source averaged for views with larger px, kept from frame to frame.
#pragma once

#include <memory>
#include <vector>

#include "frame/color_reach.h"
#include "structure/layered_buffer.h"

namespace viewloom {

// Planes for the reaches that were asked for last: what displays ask for, and how often they
// change, bounds no memory. The device must outlive it. Thread-safety: none.
class MeanColor {
 public:
  // Two displays of different px are walked in turn; more make their means anew each time.
  static constexpr uint32_t kReachesMax = 2;

  // `options`: of an array like the colour planes, of one uint a texel.
  MeanColor(const Device& device, const LayeredBufferOptions& options)
      : device_(device), options_(options) {}

  struct Planes {
    ColorReach reach;
    uint32_t made_row_count = 0;  // from the top, of the colour that the slot holds
    LayeredBuffer means;
  };
  // Allocates up to kReachesMax; then those used longest ago are to be made anew. Whoever does so
  // waits for what was submitted before.
  Planes& planesFor(const ColorReach& reach);
  // The colour planes hold another frame.
  void forget();

 private:
  const Device& device_;
  LayeredBufferOptions options_;
  std::vector<std::unique_ptr<Planes>> planes_;  // used last comes first
};

}  // namespace viewloom
