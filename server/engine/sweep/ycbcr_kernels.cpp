// SPDX-License-Identifier: Apache-2.0
#include "sweep/ycbcr_kernels.h"

#include "base/check.h"
#include "display/color_form.h"
#include "shared/ycbcr.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sweep/ycbcr_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace viewloom::HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR

// abi::lumaOf and its like, of a px.
template <typename Formula>
uint32_t apply(Formula formula, uint32_t rgba) {
  return formula(float(rgba & 0xff), float(rgba >> 8 & 0xff), float(rgba >> 16 & 0xff));
}

void Ycbcr444(const uint32_t* rgba, size_t width_px, uint8_t* luma, uint8_t* cb, uint8_t* cr) {
  for (size_t x = 0; x < width_px; ++x) {
    luma[x] = uint8_t(apply(abi::lumaOf, rgba[x]));
    cb[x] = uint8_t(apply(abi::cbOf, rgba[x]));
    cr[x] = uint8_t(apply(abi::crOf, rgba[x]));
  }
}

void Ycbcr420(const YcbcrRows420& rows, size_t width_px) {
  for (size_t x = 0; x < width_px; ++x) {
    rows.upper_luma[x] = uint8_t(apply(abi::lumaOf, rows.upper_rgba[x]));
    rows.lower_luma[x] = uint8_t(apply(abi::lumaOf, rows.lower_rgba[x]));
  }
  for (size_t x = 0; x < width_px; x += 2) {
    const uint32_t* const upper = rows.upper_rgba + x;
    const uint32_t* const lower = rows.lower_rgba + x;
    const auto mean = [&](auto of) {
      const uint32_t sum =
          apply(of, upper[0]) + apply(of, upper[1]) + apply(of, lower[0]) + apply(of, lower[1]);
      return uint8_t(abi::meanChroma(sum, uint32_t(x / 2)));
    };
    rows.cb[x / 2] = mean(abi::cbOf);
    rows.cr[x / 2] = mean(abi::crOf);
  }
}

#else

namespace hn = hwy::HWY_NAMESPACE;

// Two vectors of px make one of chroma: as long as half of what rows are padded to, at most.
using Px = hn::CappedTag<uint32_t, YcbcrLayout::kPadding_px / 2>;
using Sums = hn::RebindToSigned<Px>;
using Shorts = hn::Repartition<int16_t, Px>;
using Halves = hn::Repartition<uint16_t, Px>;
using Samples = hn::Rebind<uint8_t, Px>;
using PxVec = hn::Vec<Px>;
using SumVec = hn::Vec<Sums>;

constexpr Px kPx;
constexpr Sums kSums;
constexpr Shorts kShorts;
constexpr Halves kHalves;
constexpr Samples kSamples;

// Dot product of the halves of each pixel: low * low + high * high. Coefficients are int16_t.
HWY_INLINE SumVec dot(PxVec px, uint32_t low, uint32_t high) {
  const PxVec pairs = hn::Set(kPx, (low & 0xffffU) | high << 16);
  SumVec rest = hn::Zero(kSums);
  const SumVec sums = hn::ReorderWidenMulAccumulate(kSums, hn::BitCast(kShorts, px),
                                                    hn::BitCast(kShorts, pairs), rest, rest);
  return hn::RearrangeToOddPlusEven(sums, rest);
}

// Sums of 16 bits before the point.
struct Ycbcr {
  PxVec luma;
  PxVec cb;
  PxVec cr;
};

HWY_INLINE Ycbcr ycbcrOf(PxVec rgba) {
  const PxVec red_blue = hn::And(rgba, hn::Set(kPx, 0x00ff00ffU));
  const PxVec green = hn::And(hn::ShiftRight<8>(rgba), hn::Set(kPx, 0xffU));
  // Coefficients that do not fit int16_t: twice the half; and -32768 in a sum that is subtracted.
  static_assert(abi::kLumaOfGreen % 2 == 0 && abi::kChromaOfOwn == 32768);
  const SumVec half = dot(green, abi::kLumaOfGreen / 2, 0);
  const SumVec others = dot(red_blue, abi::kLumaOfRed, abi::kLumaOfBlue);
  const SumVec less_cb =
      hn::Add(dot(red_blue, abi::kCbLessRed, abi::kChromaOfOwn), dot(green, abi::kCbLessGreen, 0));
  const SumVec less_cr =
      hn::Add(dot(red_blue, abi::kChromaOfOwn, abi::kCrLessBlue), dot(green, abi::kCrLessGreen, 0));
  const SumVec luma = hn::Add(hn::Add(half, half), others);
  const PxVec offset = hn::Set(kPx, abi::kChromaOffset);
  return {.luma = hn::Add(hn::BitCast(kPx, luma), hn::Set(kPx, abi::kLumaOffset)),
          .cb = hn::Sub(offset, hn::BitCast(kPx, less_cb)),
          .cr = hn::Sub(offset, hn::BitCast(kPx, less_cr))};
}

// Values 0..255.
HWY_INLINE void store(PxVec values, uint8_t* samples) {
  hn::StoreU(hn::DemoteTo(kSamples, hn::BitCast(kSums, values)), kSamples, samples);
}

void Ycbcr444(const uint32_t* HWY_RESTRICT rgba, size_t width_px, uint8_t* HWY_RESTRICT luma,
              uint8_t* HWY_RESTRICT cb, uint8_t* HWY_RESTRICT cr) {
  for (size_t x = 0; x < width_px; x += hn::Lanes(kPx)) {
    const Ycbcr sums = ycbcrOf(hn::LoadU(kPx, rgba + x));
    store(hn::ShiftRight<abi::kYcbcrShift>(sums.luma), luma + x);
    store(hn::ShiftRight<abi::kYcbcrShift>(sums.cb), cb + x);
    store(hn::ShiftRight<abi::kYcbcrShift>(sums.cr), cr + x);
  }
}

// Writes the luma; Cb in the low and Cr in the high half of each px.
HWY_INLINE PxVec lumaAndChroma(const uint32_t* HWY_RESTRICT rgba, uint8_t* HWY_RESTRICT luma) {
  const Ycbcr sums = ycbcrOf(hn::LoadU(kPx, rgba));
  store(hn::ShiftRight<abi::kYcbcrShift>(sums.luma), luma);
  const PxVec cb = hn::ShiftRight<abi::kYcbcrShift>(sums.cb);
  return hn::BitCast(kPx, hn::OddEven(hn::BitCast(kHalves, sums.cr), hn::BitCast(kHalves, cb)));
}

// The chroma of px and of those below, added; in even lanes that of the px to the right as well.
HWY_INLINE PxVec chromaSums(const YcbcrRows420& rows, size_t x) {
  const PxVec upper = lumaAndChroma(rows.upper_rgba + x, rows.upper_luma + x);
  const PxVec lower = lumaAndChroma(rows.lower_rgba + x, rows.lower_luma + x);
  const auto sums = hn::Add(hn::BitCast(kHalves, upper), hn::BitCast(kHalves, lower));
  const hn::RepartitionToWide<Px> pairs;
  const auto right = hn::ShiftRight<32>(hn::BitCast(pairs, sums));
  return hn::BitCast(kPx, hn::Add(sums, hn::BitCast(kHalves, right)));
}

void Ycbcr420(const YcbcrRows420& rows, size_t width_px) {
  const size_t lanes = hn::Lanes(kPx);
  // 1 in even columns and 2 in odd ones, for Cb and for Cr (abi::meanChroma).
  const PxVec is_odd = hn::And(hn::Iota(kPx, 0), hn::Set(kPx, 1));
  const PxVec ones = hn::Set(kPx, 0x10001U);
  const PxVec rounding = hn::Add(ones, hn::And(hn::Sub(hn::Zero(kPx), is_odd), ones));
  for (size_t x = 0; x < width_px; x += 2 * lanes) {
    const PxVec left = chromaSums(rows, x);
    const PxVec right = chromaSums(rows, x + lanes);
    const PxVec sums = hn::Add(hn::ConcatEven(kPx, right, left), rounding);
    const PxVec means = hn::BitCast(kPx, hn::ShiftRight<2>(hn::BitCast(kHalves, sums)));
    store(hn::And(means, hn::Set(kPx, 0xffffU)), rows.cb + x / 2);
    store(hn::ShiftRight<16>(means), rows.cr + x / 2);
  }
}

#endif  // vectors

}  // namespace viewloom::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace viewloom {

HWY_EXPORT(Ycbcr444);
HWY_EXPORT(Ycbcr420);

void ycbcrRow444(const uint32_t* rgba, size_t width_px, uint8_t* luma, uint8_t* cb, uint8_t* cr) {
  VIEWLOOM_CHECK(width_px % YcbcrLayout::kPadding_px == 0);
  HWY_DYNAMIC_DISPATCH(Ycbcr444)(rgba, width_px, luma, cb, cr);
}

void ycbcrRows420(const YcbcrRows420& rows, size_t width_px) {
  VIEWLOOM_CHECK(width_px % YcbcrLayout::kPadding_px == 0);
  HWY_DYNAMIC_DISPATCH(Ycbcr420)(rows, width_px);
}

}  // namespace viewloom
#endif
