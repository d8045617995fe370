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

// Sign, 6 bits of exponent (1 stands for 2^-39), 9 of mantissa below the hidden one.
float readSlope(uint32_t half) {
  const int exponent = int(bitsOf(half, 9, 14));
  if (exponent == 0) return 0;
  const float magnitude = std::ldexp(1.0f + float(bitsOf(half, 0, 8)) / 512.0f, exponent - 40);
  return bitsOf(half, 15, 15) != 0 ? -magnitude : magnitude;
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
    // Half octaves from 2^-28.
    const int half_octaves = int(bitsOf(bits.x, 3, 8));
    const float octave = std::ldexp(1.0f, half_octaves / 2 - 28);
    node.error = half_octaves % 2 == 0 ? octave : octave * 1.41421356f;
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
