// SPDX-License-Identifier: Apache-2.0
// Texels as vectors of their channels, for each kind of CPU anew.
#if defined(VIEWLOOM_SERVER_SWEEP_PACKED_CHANNELS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VIEWLOOM_SERVER_SWEEP_PACKED_CHANNELS_INL_H_
#undef VIEWLOOM_SERVER_SWEEP_PACKED_CHANNELS_INL_H_
#else
#define VIEWLOOM_SERVER_SWEEP_PACKED_CHANNELS_INL_H_
#endif

#include "sweep/packed_codes.h"
#include "sweep/vectors_inl.h"

HWY_BEFORE_NAMESPACE();
namespace viewloom::HWY_NAMESPACE {

// Each in the steps of packed codes.
struct Channels {
  Vec red, green, blue;
};

HWY_INLINE Vec fieldOf(WordVec texels, int shift, uint32_t mask) {
  const WordVec field = hn::And(hn::ShiftRightSame(texels, shift), hn::Set(kWords, mask));
  return hn::ConvertTo(kFloats, hn::BitCast(kInts, field));
}

// kIsPacked: packed codes; else codes of 8 bits, red in the low byte.
template <bool kIsPacked>
HWY_INLINE Channels channelsOf(WordVec texels) {
  if (kIsPacked) {
    return {fieldOf(texels, 0, kRedMask), fieldOf(texels, kGreenShift, kGreenMask),
            fieldOf(texels, kBlueShift, kBlueMask)};
  }
  return {hn::Mul(fieldOf(texels, 0, 255), set(kRedSteps)),
          hn::Mul(fieldOf(texels, 8, 255), set(kGreenSteps)),
          hn::Mul(fieldOf(texels, 16, 255), set(kBlueSteps))};
}

// The sums of two texels of packed codes, with one conversion.
HWY_INLINE Channels channelsOfBoth(WordVec a, WordVec b) {
  const auto sum = [&](int shift, uint32_t mask) {
    const WordVec fields = hn::Set(kWords, mask);
    const WordVec both = hn::Add(hn::And(hn::ShiftRightSame(a, shift), fields),
                                 hn::And(hn::ShiftRightSame(b, shift), fields));
    return hn::ConvertTo(kFloats, hn::BitCast(kInts, both));
  };
  return {sum(0, kRedMask), sum(kGreenShift, kGreenMask), sum(kBlueShift, kBlueMask)};
}

HWY_INLINE WordVec packChannels(const Channels& channels) {
  const auto steps = [](Vec channel) { return hn::BitCast(kWords, hn::NearestInt(channel)); };
  return hn::Or(hn::Or(steps(channels.red), hn::ShiftLeft<kGreenShift>(steps(channels.green))),
                hn::ShiftLeft<kBlueShift>(steps(channels.blue)));
}

}  // namespace viewloom::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard, once for each kind of CPU
