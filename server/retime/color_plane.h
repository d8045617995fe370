// SPDX-License-Identifier: Apache-2.0
// Texels of colour planes, whatever they are stored as.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "frame/frame.h"

namespace viewloom {

// A texel's channels, in the codes it came in.
using Texel = std::array<float, 4>;

inline Texel mixed(const Texel& a, float share_a, const Texel& b, float share_b) {
  Texel sum;
  for (size_t i = 0; i < sum.size(); ++i) sum[i] = share_a * a[i] + share_b * b[i];
  return sum;
}

// Colour planes of one encoding: RGBA8 or RGBA16F.
struct ColorPlane {
  const uint8_t* texels = nullptr;
  PlaneEncoding encoding = PlaneEncoding::kRgba8;

  Texel at(uint32_t px) const {
    if (encoding == PlaneEncoding::kRgba16f) return halvesAt(px);
    Texel texel;
    for (size_t i = 0; i < texel.size(); ++i) texel[i] = texels[4 * size_t{px} + i];
    return texel;
  }

 private:
  Texel halvesAt(uint32_t px) const;
};
void storeTexel(PlaneEncoding encoding, const Texel& texel, uint32_t px, uint8_t* texels);

}  // namespace viewloom
