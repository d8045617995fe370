// SPDX-License-Identifier: Apache-2.0
#include "retime/color_plane.h"

#include <algorithm>
#include <cstring>

#include <glm/gtc/packing.hpp>

namespace viewloom {
namespace {

constexpr float kHalfMax = 65504;

}  // namespace

Texel ColorPlane::halvesAt(uint32_t px) const {
  Texel texel;
  uint16_t halves[4];
  std::memcpy(halves, texels + 8 * size_t{px}, sizeof halves);
  for (size_t i = 0; i < texel.size(); ++i) texel[i] = glm::unpackHalf1x16(halves[i]);
  return texel;
}

void storeTexel(PlaneEncoding encoding, const Texel& texel, uint32_t px, uint8_t* texels) {
  for (size_t i = 0; i < texel.size(); ++i) {
    if (encoding != PlaneEncoding::kRgba16f) {
      texels[4 * size_t{px} + i] = uint8_t(std::clamp(texel[i] + 0.5F, 0.0F, 255.0F));
      continue;
    }
    const uint16_t half = glm::packHalf1x16(std::clamp(texel[i], 0.0F, kHalfMax));
    std::memcpy(texels + 8 * size_t{px} + 2 * i, &half, sizeof half);
  }
}

}  // namespace viewloom
