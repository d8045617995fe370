// SPDX-License-Identifier: Apache-2.0
// Which px pieces of surface cover, with the vectors of the CPU it runs on.
#pragma once

#include <bit>
#include <cstdint>

#include "retime/moved_samples.h"
#include "sweep/surface_row.h"

namespace viewloom {

// Pieces of surface that a sample owns, in the low bits of their number: its px as it stands, the
// two triangles of the quad that it begins, the four quadrants of its footprint.
inline constexpr uint32_t kPieceKinds = 8;
inline constexpr uint32_t kStillPx = 0;
inline constexpr uint32_t kUpperTriangle = 1;
inline constexpr uint32_t kLowerTriangle = 2;
inline constexpr uint32_t kFirstQuadrant = 3;
// All samples of the largest source have numbers.
static_assert(uint64_t{8192} * 8192 * 4 * kPieceKinds <= UINT32_MAX);

// Number of a piece that a pixel may show, nearest first: 1/Z (not negative) before the number of
// the piece.
inline uint64_t pieceKey(float inv_z, uint32_t piece) {
  return uint64_t{std::bit_cast<uint32_t>(inv_z)} << 32 | (UINT32_MAX - piece);
}
inline float invZOfKey(uint64_t key) {
  return std::bit_cast<float>(uint32_t(key >> 32));
}

// Pieces at the px whose middles they cover.
inline constexpr uint32_t kQuadsPerCall = 64;
struct Fragments {
  // Neighbours in a quad are no further apart than two px each way, so its corners lie within
  // three: its px within four by four, of which each is offered both triangles.
  static constexpr uint32_t kCountMax = kQuadsPerCall * 4 * 4 * 2;

  uint64_t keys[kCountMax];
  uint64_t px[kCountMax];
  uint32_t count = 0;
};

// Draws the quads (MovedSamples::quads) that begin at `count` pixels, at most kQuadsPerCall, of a
// row of a layer. Forgets earlier keys.
void drawQuads(const MovedSamples& samples, uint32_t layer, uint32_t px, uint32_t count,
               Fragments& fragments);

// The nearest of the samples of all layers that stand, of `count` px from `px` on, as keys, 0 where
// there is none. Of those behind `in_front`, [px] in 1/m, if that is given; nothing is behind
// nothing.
void drawStill(const MovedSamples& samples, uint32_t px, uint32_t count, const float* in_front,
               uint64_t* keys);

}  // namespace viewloom
