// SPDX-License-Identifier: Apache-2.0
// Vectors of binary64 that kernels of this folder compute places with, for each kind of CPU anew.
#if defined(VIEWLOOM_SERVER_RETIME_DOUBLES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VIEWLOOM_SERVER_RETIME_DOUBLES_INL_H_
#undef VIEWLOOM_SERVER_RETIME_DOUBLES_INL_H_
#else
#define VIEWLOOM_SERVER_RETIME_DOUBLES_INL_H_
#endif

#include <hwy/highway.h>

#include "sweep/vectors_inl.h"

HWY_BEFORE_NAMESPACE();
namespace viewloom::HWY_NAMESPACE {

using Doubles = hn::ScalableTag<double>;
using Longs = hn::RebindToUnsigned<Doubles>;
using DoubleVec = hn::Vec<Doubles>;
using LongVec = hn::Vec<Longs>;
using DoubleMask = hn::Mask<Doubles>;
// The same number of lanes, with half the bits.
using HalfFloats = hn::Rebind<float, Doubles>;
using HalfWords = hn::Rebind<uint32_t, Doubles>;
using HalfInts = hn::Rebind<int32_t, Doubles>;
using EighthBytes = hn::Rebind<uint8_t, Doubles>;

constexpr Doubles kDoubles;
constexpr Longs kLongs;

HWY_INLINE DoubleVec setDouble(double value) {
  return hn::Set(kDoubles, value);
}

HWY_INLINE DoubleVec loadDoubles(const float* values) {
  return hn::PromoteTo(kDoubles, hn::LoadU(HalfFloats(), values));
}

HWY_INLINE void storeFloats(DoubleVec values, float* to) {
  hn::StoreU(hn::DemoteTo(HalfFloats(), values), HalfFloats(), to);
}

HWY_INLINE LongVec loadLongs(const uint8_t* bytes) {
  return hn::PromoteTo(kLongs, hn::PromoteTo(HalfWords(), hn::LoadU(EighthBytes(), bytes)));
}

// 1 where set, else 0.
HWY_INLINE void storeBytes(DoubleMask those, uint8_t* to) {
  const LongVec ones = hn::IfThenElseZero(hn::RebindMask(kLongs, those), hn::Set(kLongs, 1));
  hn::StoreU(hn::TruncateTo(EighthBytes(), ones), EighthBytes(), to);
}

HWY_INLINE DoubleVec cross(DoubleVec ax, DoubleVec ay, DoubleVec bx, DoubleVec by) {
  return hn::Sub(hn::Mul(ax, by), hn::Mul(ay, bx));
}

}  // namespace viewloom::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard, once for each kind of CPU
