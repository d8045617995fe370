// SPDX-License-Identifier: Apache-2.0
#include "sweep/color_kernels.h"

#include <algorithm>

#include "sweep/packed_codes.h"
#include "sweep/surface_row.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sweep/color_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sweep/vectors_inl.h"

HWY_BEFORE_NAMESPACE();
namespace viewloom::HWY_NAMESPACE {

// A channel of packed codes, in its steps.
HWY_INLINE Vec stepsOf(WordVec texel, int shift, uint32_t mask) {
  const WordVec steps = hn::And(hn::ShiftRightSame(texel, shift), hn::Set(kWords, mask));
  return hn::ConvertTo(kFloats, hn::BitCast(kInts, steps));
}

// The code, 0..255, of a blend: in the low byte; above it are the bits of 2^23.
HWY_INLINE WordVec codeOf(WordVec texel, WordVec next, Vec share, int shift, uint32_t mask,
                          float steps) {
  const Vec from = stepsOf(texel, shift, mask);
  const Vec blend = hn::MulAdd(share, hn::Sub(stepsOf(next, shift, mask), from), from);
  // Above 2^23 the steps of floats are 1: their low bits are the code, rounded.
  return hn::BitCast(kWords, hn::MulAdd(blend, set(1 / steps), set(0x1p23F)));
}

HWY_INLINE WordVec colorAt(const uint32_t* texels, IntVec last_index, IntVec place,
                           uint32_t background) {
  const IntVec index = hn::Min(hn::Max(hn::ShiftRight<8>(place), hn::Zero(kInts)), last_index);
  const IntVec steps = hn::And(place, hn::Set(kInts, kSubtexelSteps - 1));
  const Vec share = hn::Mul(hn::ConvertTo(kFloats, steps), set(1.0F / kSubtexelSteps));
  const WordVec texel = hn::GatherIndex(kWords, texels, index);
  const WordVec next = hn::GatherIndex(kWords, texels + 1, index);
  const WordVec red = codeOf(texel, next, share, 0, kRedMask, kRedSteps);
  const WordVec green = codeOf(texel, next, share, kGreenShift, kGreenMask, kGreenSteps);
  const WordVec blue = codeOf(texel, next, share, kBlueShift, kBlueMask, kBlueSteps);
  // The bits of 2^23 are shifted out, or lie under alpha.
  const WordVec color = hn::Or(hn::Or(red, hn::ShiftLeft<8>(green)),
                               hn::Or(hn::ShiftLeft<16>(blue), hn::Set(kWords, 0xff000000U)));
  const auto is_background = hn::RebindMask(kWords, hn::Lt(place, hn::Zero(kInts)));
  return hn::IfThenElse(is_background, hn::Set(kWords, background), color);
}

void ColorRow(const uint32_t* HWY_RESTRICT texels, uint32_t texel_count,
              const int32_t* HWY_RESTRICT places, size_t width_px, uint32_t background,
              uint32_t* HWY_RESTRICT rgba) {
  const size_t lanes = hn::Lanes(kFloats);
  // Whatever a place is, no texel is read that is not there.
  const IntVec last_index = hn::Set(kInts, int32_t(std::max(texel_count, 2U)) - 2);
  size_t p = 0;
  for (; p + lanes <= width_px; p += lanes) {
    hn::StoreU(colorAt(texels, last_index, hn::Load(kInts, places + p), background), kWords,
               rgba + p);
  }
  if (p == width_px) return;
  const auto exists = hn::FirstN(kInts, width_px - p);
  HWY_ALIGN uint32_t last[HWY_MAX_BYTES / sizeof(uint32_t)];
  hn::Store(colorAt(texels, last_index, hn::IfThenElseZero(exists, hn::Load(kInts, places + p)),
                    background),
            kWords, last);
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
