// SPDX-License-Identifier: Apache-2.0
#include "sweep/smooth_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sweep/smooth_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "shared/structure_abi.h"
#include "sweep/vectors_inl.h"

HWY_BEFORE_NAMESPACE();
namespace viewloom::HWY_NAMESPACE {

// The surface of each column whose inv_z is nearest; kNoSurface where there is none.
template <uint32_t kLayers>
HWY_INLINE Vec nearestIn(const ByLayer<const float*>& rows, size_t x, int shift, Vec inv_z) {
  Vec nearest = loadAt(rows, 0, x, shift);
  for (uint32_t i = 1; i < kLayers; ++i) {
    const Vec other = loadAt(rows, i, x, shift);
    const Mask is_nearer = hn::Lt(hn::Abs(hn::Sub(other, inv_z)), hn::Abs(hn::Sub(nearest, inv_z)));
    nearest = hn::IfThenElse(hn::And(is_nearer, hn::Ge(other, hn::Zero(kFloats))), other, nearest);
  }
  return nearest;
}

// How far the mean of both neighbours lies from inv_z; less where that is no longer what one
// surface could do, down to 0.
HWY_INLINE Vec bendBetween(Vec a, Vec b, Vec inv_z, float reach) {
  const Vec zero = hn::Zero(kFloats);
  const Vec bend = hn::Mul(set(0.5F), hn::Add(hn::Sub(a, inv_z), hn::Sub(b, inv_z)));
  const Vec larger = hn::Max(hn::Abs(bend), hn::Abs(hn::Sub(b, a)));
  const Vec most = hn::Max(hn::Sub(set(abi::kPairReaches * reach), larger), zero);
  const Vec taken = hn::Min(hn::Max(bend, hn::Neg(most)), most);
  return hn::IfThenElseZero(hn::Gt(hn::Min(a, b), zero), taken);
}

// Within reach of the samples, and not through the layers beside it.
template <uint32_t kLayers>
HWY_INLINE Vec withinReach(const SmoothedRow& row, uint32_t layer, size_t x, Vec inv_z) {
  const Vec gap_share = set(abi::kSmoothingGapShare);
  const Vec sample = loadAt(row.samples, layer, x, 0);
  const Vec before = layer > 0 ? loadAt(row.samples, layer - 1, x, 0) : set(3.4e38F);
  const Vec behind = layer + 1 < kLayers
                         ? hn::Max(loadAt(row.samples, layer + 1, x, 0), hn::Zero(kFloats))
                         : hn::Zero(kFloats);
  const Vec down = hn::Min(set(row.reach), hn::Mul(gap_share, hn::Sub(sample, behind)));
  const Vec up = hn::Min(set(row.reach), hn::Mul(gap_share, hn::Sub(before, sample)));
  const Vec result = hn::Min(hn::Max(inv_z, hn::Sub(sample, down)), hn::Add(sample, up));
  // Neither the sky nor what is no surface is rounded.
  return hn::IfThenElse(hn::Gt(sample, hn::Zero(kFloats)), result, sample);
}

template <uint32_t kLayers>
HWY_INLINE void smoothVector(const SmoothedRow& row, size_t x) {
  const int s = row.stride;
  Vec results[kLayers];
  for (uint32_t i = 0; i < kLayers; ++i) {
    const Vec inv_z = loadAt(row.here, i, x, 0);
    const auto bend = [&](const ByLayer<const float*>& before, int shift_before,
                          const ByLayer<const float*>& after, int shift_after) HWY_ATTR {
      return bendBetween(nearestIn<kLayers>(before, x, shift_before, inv_z),
                         nearestIn<kLayers>(after, x, shift_after, inv_z), inv_z, row.reach);
    };
    Vec sum = hn::Add(bend(row.here, -s, row.here, s), bend(row.above, 0, row.below, 0));
    sum = hn::Add(sum, bend(row.above, -s, row.below, s));
    sum = hn::Add(sum, bend(row.below, -s, row.above, s));
    const Vec moved = hn::Add(inv_z, hn::Mul(set(abi::kSmoothingShare), sum));
    results[i] = withinReach<kLayers>(row, i, x, moved);
  }
  // Samples that are written over are needed for all layers first.
  for (uint32_t i = 0; i < kLayers; ++i) hn::StoreU(results[i], kFloats, row.result[i] + x);
}

template <uint32_t kLayers>
HWY_INLINE void smoothVectors(const SmoothedRow& row) {
  for (size_t x = 0; x < row.width; x += hn::Lanes(kFloats)) smoothVector<kLayers>(row, x);
}

void SmoothRow(const SmoothedRow& row) {
  VIEWLOOM_BY_LAYER_COUNT(row.layer_count, smoothVectors, row)
}

}  // namespace viewloom::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace viewloom {

HWY_EXPORT(SmoothRow);

void smoothRow(const SmoothedRow& row) {
  HWY_DYNAMIC_DISPATCH(SmoothRow)(row);
}

}  // namespace viewloom
#endif
