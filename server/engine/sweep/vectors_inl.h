// SPDX-License-Identifier: Apache-2.0
// The vectors of the CPU that kernels of this folder compute with, for each kind of CPU anew.
#if defined(VIEWLOOM_SERVER_SWEEP_VECTORS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VIEWLOOM_SERVER_SWEEP_VECTORS_INL_H_
#undef VIEWLOOM_SERVER_SWEEP_VECTORS_INL_H_
#else
#define VIEWLOOM_SERVER_SWEEP_VECTORS_INL_H_
#endif

#include <hwy/highway.h>

#include "sweep/surface_row.h"

HWY_BEFORE_NAMESPACE();
namespace viewloom::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::ScalableTag<float>;
using Words = hn::RebindToUnsigned<Floats>;
using Ints = hn::RebindToSigned<Floats>;
using Bytes = hn::Rebind<uint8_t, Floats>;
using Vec = hn::Vec<Floats>;
using WordVec = hn::Vec<Words>;
using IntVec = hn::Vec<Ints>;
using Mask = hn::Mask<Floats>;

constexpr Floats kFloats;
constexpr Words kWords;
constexpr Ints kInts;

HWY_INLINE Vec set(float value) {
  return hn::Set(kFloats, value);
}

HWY_INLINE Mask noLane() {
  return hn::FirstN(kFloats, 0);
}

// Writes those lanes of a vector one after the other, and whatever else up to a whole vector;
// returns how many. Compressed in a register: some CPUs write compressed lanes one by one.
template <class Tag, class Value, class Lanes>
HWY_INLINE uint32_t storeThose(Tag tag, Value value, Lanes those, hn::TFromD<Tag>* to) {
  hn::StoreU(hn::Compress(value, those), tag, to);
  return uint32_t(hn::CountTrue(tag, those));
}

// `shift` columns beside `x`, of a row of a layer.
HWY_INLINE Vec loadAt(const ByLayer<const float*>& rows, uint32_t layer, size_t x, int shift) {
  return hn::LoadU(kFloats, rows[layer] + x + shift);
}

// Calls function<layer_count>(...): loops over layers are unrolled.
#undef VIEWLOOM_BY_LAYER_COUNT
#define VIEWLOOM_BY_LAYER_COUNT(layer_count, function, ...) \
  switch (layer_count) {                                    \
    case 1:                                                 \
      return function<1>(__VA_ARGS__);                      \
    case 2:                                                 \
      return function<2>(__VA_ARGS__);                      \
    case 3:                                                 \
      return function<3>(__VA_ARGS__);                      \
    default:                                                \
      return function<4>(__VA_ARGS__);                      \
  }

}  // namespace viewloom::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard, once for each kind of CPU
