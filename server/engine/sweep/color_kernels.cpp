// SPDX-License-Identifier: Apache-2.0
#include "sweep/color_kernels.h"

#include <algorithm>
#include <cstring>

#include "sweep/surface_row.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sweep/color_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sweep/packed_channels_inl.h"

HWY_BEFORE_NAMESPACE();
namespace viewloom::HWY_NAMESPACE {

// The code, 0..255, of a blend: in the low byte; above it are the bits of 2^23.
HWY_INLINE WordVec codeOf(WordVec texel, WordVec next, Vec share, int shift, uint32_t mask,
                          float steps) {
  const Vec from = fieldOf(texel, shift, mask);
  const Vec blend = hn::MulAdd(share, hn::Sub(fieldOf(next, shift, mask), from), from);
  // Above 2^23 the steps of floats are 1: their low bits are the code, rounded.
  return hn::BitCast(kWords, hn::MulAdd(blend, set(1 / steps), set(0x1p23F)));
}

HWY_INLINE WordVec colorAt(WordVec texel, WordVec next, IntVec place, uint32_t background) {
  const IntVec steps = hn::And(place, hn::Set(kInts, kSubtexelSteps - 1));
  const Vec share = hn::Mul(hn::ConvertTo(kFloats, steps), set(1.0F / kSubtexelSteps));
  const WordVec red = codeOf(texel, next, share, 0, kRedMask, kRedSteps);
  const WordVec green = codeOf(texel, next, share, kGreenShift, kGreenMask, kGreenSteps);
  const WordVec blue = codeOf(texel, next, share, kBlueShift, kBlueMask, kBlueSteps);
  // The bits of 2^23 are shifted out, or lie under alpha.
  const WordVec color = hn::Or(hn::Or(red, hn::ShiftLeft<8>(green)),
                               hn::Or(hn::ShiftLeft<16>(blue), hn::Set(kWords, 0xff000000U)));
  const auto is_background = hn::RebindMask(kWords, hn::Lt(place, hn::Zero(kInts)));
  return hn::IfThenElse(is_background, hn::Set(kWords, background), color);
}

// Px that are coloured together.
constexpr size_t kChunk_px = 64;
static_assert(kChunk_px % (HWY_MAX_BYTES / sizeof(float)) == 0);

// Both texels of each place are fetched as one word of 64 bits, one by one, which is faster than
// gathers. They are read as vectors only when all are there, long after they were written.
HWY_INLINE void colorChunk(const uint32_t* HWY_RESTRICT texels, IntVec last_index,
                           const int32_t* HWY_RESTRICT places, uint32_t background,
                           uint32_t* HWY_RESTRICT rgba) {
  HWY_ALIGN int32_t indices[kChunk_px];
  HWY_ALIGN uint32_t pairs[2 * kChunk_px];
  const size_t lanes = hn::Lanes(kFloats);
  for (size_t p = 0; p < kChunk_px; p += lanes) {
    const IntVec index = hn::ShiftRight<8>(hn::LoadU(kInts, places + p));
    hn::Store(hn::Min(hn::Max(index, hn::Zero(kInts)), last_index), kInts, indices + p);
  }
  for (size_t p = 0; p < kChunk_px; ++p) {
    std::memcpy(pairs + 2 * p, texels + indices[p], 2 * sizeof(uint32_t));
  }
  for (size_t p = 0; p < kChunk_px; p += lanes) {
    WordVec texel;
    WordVec next;
    hn::LoadInterleaved2(kWords, pairs + 2 * p, texel, next);
    hn::StoreU(colorAt(texel, next, hn::LoadU(kInts, places + p), background), kWords, rgba + p);
  }
}

void ColorRow(const uint32_t* HWY_RESTRICT texels, uint32_t texel_count,
              const int32_t* HWY_RESTRICT places, size_t width_px, uint32_t background,
              uint32_t* HWY_RESTRICT rgba) {
  // Whatever a place is, no texel is read that is not there.
  const IntVec last_index = hn::Set(kInts, int32_t(std::max(texel_count, 2U)) - 2);
  size_t p = 0;
  for (; p + kChunk_px <= width_px; p += kChunk_px) {
    colorChunk(texels, last_index, places + p, background, rgba + p);
  }
  if (p == width_px) return;
  HWY_ALIGN int32_t last_places[kChunk_px] = {};
  uint32_t last[kChunk_px];
  std::copy_n(places + p, width_px - p, last_places);
  colorChunk(texels, last_index, last_places, background, last);
  std::copy_n(last, width_px - p, rgba + p);
}

}  // namespace viewloom::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace viewloom {

HWY_EXPORT(ColorRow);

void colorRow(const uint32_t* texels, uint32_t texel_count, const int32_t* places, size_t width_px,
              uint32_t background, uint32_t* rgba) {
  HWY_DYNAMIC_DISPATCH(ColorRow)(texels, texel_count, places, width_px, background, rgba);
}

}  // namespace viewloom
#endif
