// SPDX-License-Identifier: Apache-2.0
// The samples that px lie between, and texels blended by them, with the vectors of the CPU it runs
// on.
#pragma once

#include <array>
#include <cstdint>

#include "retime/moved_samples.h"
#include "sweep/aligned_array.h"

namespace viewloom {

// Of px one after the other; all arrays are [px], with room for a vector beyond. A px that is one
// sample's has it three times, and its whole share first.
struct BlendedRow {
  void reserve(uint32_t width);

  AlignedArray<float> inv_z;  // 1/m, abi::kNoSurface where there is nothing; the rest is then void
  AlignedArray<uint32_t> main;  // the sample that most of it is
  std::array<AlignedArray<uint32_t>, 3> samples;
  std::array<AlignedArray<float>, 3> shares;     // their sum is 1
  std::array<AlignedArray<uint32_t>, 3> texels;  // of these samples, RGBA8
};

// What pieces show at `count` px from `px` on. `keys`: of these (pieceKey()), 0 where there is
// none; may be read a vector beyond.
void findBlends(const MovedSamples& samples, uint32_t px, uint32_t count, const uint64_t* keys,
                BlendedRow& row);

// RGBA8[count]
void blendTexels(const BlendedRow& row, uint32_t count, uint8_t* color);

}  // namespace viewloom
