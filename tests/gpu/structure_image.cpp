// SPDX-License-Identifier: Apache-2.0
#include "gpu/structure_image.h"

#include <bit>
#include <cmath>

namespace viewloom {
namespace {

// Bits `first`..`last` of a word.
uint32_t bitsOf(uint32_t word, int first, int last) {
  return (word << (31 - last)) >> (31 - last + first);
}

// The upper half of a binary32.
float readSlope(uint32_t half) {
  return std::bit_cast<float>(half << 16);
}

}  // namespace

PlainFacet readFacet(const PackedPair& bits) {
  if (bits.x == 0xffffffffu) return {};
  return {.exists = true,
          .leads_forward = bitsOf(bits.x, 31, 31) != 0,
          .inv_z = std::bit_cast<float>(bitsOf(bits.x, 0, 30)),
          .slope_x = readSlope(bitsOf(bits.y, 0, 15)),
          .slope_y = readSlope(bitsOf(bits.y, 16, 31))};
}

PlainNode readNode(const PackedPair& bits) {
  PlainNode node;
  node.is_plane = bitsOf(bits.x, 31, 31) != 0;
  node.level = int(bitsOf(bits.x, 0, 2));
  if (node.is_plane) {
    node.inv_z = std::bit_cast<float>(bitsOf(bits.x, 9, 30) << 9);
    node.slope_x = readSlope(bitsOf(bits.y, 0, 15));
    node.slope_y = readSlope(bitsOf(bits.y, 16, 31));
    // 1 and 1.5 times the powers of two from 2^-28.
    const int code = int(bitsOf(bits.x, 3, 8));
    node.error = std::ldexp(code % 2 == 0 ? 1.0f : 1.5f, code / 2 - 28);
  } else {
    node.low = std::bit_cast<float>(bitsOf(bits.x, 3, 30) << 3);
    node.high = std::bit_cast<float>(bits.y);
  }
  return node;
}

int readLink(uint16_t links, int edge) {
  return int(bitsOf(links, 3 * edge, 3 * edge + 2));
}

}  // namespace viewloom
