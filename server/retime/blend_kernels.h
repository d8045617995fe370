// SPDX-License-Identifier: Apache-2.0
// The samples that px lie between, and texels blended by them, with the vectors of the CPU it runs
// on.
#pragma once

#include <array>
#include <cstdint>

#include "retime/moved_samples.h"
#include "sweep/aligned_array.h"
#include "sweep/surface_row.h"

namespace viewloom {

// Blends of consecutive pixels; all arrays are [px], with room for a vector beyond. A pixel with a
// single sample has it three times, with its whole share first.
struct BlendedRow {
  void reserve(uint32_t width);

  AlignedArray<float> inv_z;    // 1/m, abi::kNoSurface where there is nothing
  AlignedArray<uint32_t> main;  // the sample that most of it is
  std::array<AlignedArray<uint32_t>, 3> samples;
  std::array<AlignedArray<float>, 3> shares;  // their sum is 1
};

// Finds the blends that pieces show at `count` pixels from `px` on. `keys`: their pieceKey(), 0
// where there is none; may be read a vector beyond.
void findBlends(const MovedSamples& samples, uint32_t px, uint32_t count, const uint64_t* keys,
                BlendedRow& row);

struct TexelPlanes {
  ByLayer<const uint8_t*> color{};  // RGBA8[px]
  uint32_t area_px = 0;
  const uint32_t* marks = nullptr;  // [px], of the first layer: not 0 where texels do not count
};

// Writes RGBA8[count], 0 where there is nothing. Returns the number of px that have a sample with a
// mark; which they are, in `marked`, with room for a vector beyond `count`.
uint32_t blendTexels(const TexelPlanes& planes, const BlendedRow& row, uint32_t count,
                     uint8_t* color, uint32_t* marked);

}  // namespace viewloom
