// SPDX-License-Identifier: Apache-2.0
// Makes planes of samples smaller.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "frame/size.h"

namespace viewloom {

// Weights that make one line of samples out of another.
class LineWeights {
 public:
  // `ratio`: samples of the source for each one that is made; at least 1. The centre of the source
  // stays where it is at 0. Samples past the end are those at the end.
  LineWeights(uint32_t from_count, uint32_t to_count, double ratio);

  uint32_t size() const { return uint32_t(firsts_.size()); }
  uint32_t tapCount() const { return tap_count_; }
  // First sample of the source that sample `index` takes. All its taps lie in the source.
  uint32_t first(uint32_t index) const { return firsts_[index]; }
  // Weights of the taps of sample `index`; their sum is 1.
  const float* weights(uint32_t index) const { return &weights_[size_t{index} * tap_count_]; }

 private:
  uint32_t tap_count_;
  std::vector<uint32_t> firsts_;
  std::vector<float> weights_;
};

// Scales planes of one size with a cubic filter (Catmull-Rom), widened by the ratio, so that fine
// structures fade instead of aliasing. Thread-safety: none; it has memory for the rows between.
class PlaneScaler {
 public:
  // Ratios: as in LineWeights, of columns and rows.
  PlaneScaler(SizePx from_px, SizePx to_px, double column_ratio, double row_ratio);

  // from: uint8_t[from height][from_stride_bytes], to: uint8_t[to height][to_stride_bytes].
  void scale(const uint8_t* from, size_t from_stride_bytes, uint8_t* to, size_t to_stride_bytes);

 private:
  LineWeights columns_;
  LineWeights rows_;
  std::vector<float> between_;  // [from height][to width]
  std::vector<float> sums_;     // [to width]
};

}  // namespace viewloom
