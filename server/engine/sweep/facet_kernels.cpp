// SPDX-License-Identifier: Apache-2.0
#include "sweep/facet_kernels.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sweep/facet_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sweep/vectors_inl.h"

HWY_BEFORE_NAMESPACE();
namespace viewloom::HWY_NAMESPACE {

// The surface of each column whose inv_z is nearest; kNoSurface where there is none.
template <uint32_t kLayers>
HWY_INLINE Vec nearestIn(const ByLayer<const float*>& rows, size_t x, int shift, Vec inv_z) {
  Vec nearest = loadAt(rows, 0, x, shift);
  for (uint32_t i = 1; i < kLayers; ++i) {
    const Vec other = loadAt(rows, i, x, shift);
    const Mask is_nearer =
        hn::And(hn::Ge(other, hn::Zero(kFloats)),
                hn::Lt(hn::Abs(hn::Sub(other, inv_z)), hn::Abs(hn::Sub(nearest, inv_z))));
    nearest = hn::IfThenElse(is_nearer, other, nearest);
  }
  return nearest;
}

HWY_INLINE Vec minmod(Vec a, Vec b) {
  const Vec smaller = hn::IfThenElse(hn::Le(hn::Abs(a), hn::Abs(b)), a, b);
  return hn::IfThenElseZero(hn::Gt(hn::Mul(a, b), hn::Zero(kFloats)), smaller);
}

// 8 significant bits, half away from zero; what is below 2^-100 is 0.
HWY_INLINE Vec roundedSlope(Vec slope) {
  const WordVec bits = hn::BitCast(kWords, slope);
  const WordVec rounded =
      hn::And(hn::Add(bits, hn::Set(kWords, 0x8000U)), hn::Set(kWords, 0xffff0000U));
  return hn::IfThenElseZero(hn::Ge(hn::Abs(slope), set(0x1p-100F)), hn::BitCast(kFloats, rounded));
}

// The columns one and two px before and after, and how far they lie along the row.
struct Neighbors {
  const ByLayer<const float*>& before_2;
  const ByLayer<const float*>& before_1;
  const ByLayer<const float*>& after_1;
  const ByLayer<const float*>& after_2;
  int step_px;  // along the row
};

template <uint32_t kLayers>
HWY_INLINE Vec slopeAlong(const Neighbors& rows, size_t x, Vec inv_z) {
  const Vec zero = hn::Zero(kFloats);
  const Vec before = nearestIn<kLayers>(rows.before_1, x, -rows.step_px, inv_z);
  const Vec after = nearestIn<kLayers>(rows.after_1, x, rows.step_px, inv_z);
  const Mask has_before = hn::Ge(before, zero);
  const Mask has_after = hn::Ge(after, zero);
  const Vec both = minmod(hn::Sub(inv_z, before), hn::Sub(after, inv_z));
  const Mask exists = hn::Ge(inv_z, zero);
  const Mask has_both = hn::And(has_before, has_after);
  if (HWY_LIKELY(hn::AllFalse(kFloats, hn::AndNot(has_both, exists)))) return roundedSlope(both);
  // With one neighbour alone: the column beyond it.
  const Vec neighbor = hn::IfThenElse(has_after, after, before);
  const Vec before_beyond = nearestIn<kLayers>(rows.before_2, x, -2 * rows.step_px, neighbor);
  const Vec after_beyond = nearestIn<kLayers>(rows.after_2, x, 2 * rows.step_px, neighbor);
  const Vec beyond = hn::IfThenElse(has_after, after_beyond, before_beyond);
  const Vec outward = minmod(hn::Sub(neighbor, inv_z), hn::Sub(beyond, neighbor));
  const Vec one_sided = hn::IfThenElseZero(hn::Ge(hn::Min(neighbor, beyond), zero),
                                           hn::IfThenElse(has_after, outward, hn::Neg(outward)));
  return roundedSlope(hn::IfThenElse(has_both, both, one_sided));
}

template <uint32_t kLayers>
void slopesOf(const FiveRows& rows, const Neighbors& neighbors, const ByLayer<float*>& slope) {
  for (size_t x = 0; x < rows.width; x += hn::Lanes(kFloats)) {
    for (uint32_t i = 0; i < kLayers; ++i) {
      const Vec inv_z = loadAt(rows.inv_z[2], i, x, 0);
      // Deeper layers are mostly empty.
      const bool is_empty = i > 0 && hn::AllFalse(kFloats, hn::Ge(inv_z, hn::Zero(kFloats)));
      const Vec slopes = is_empty ? hn::Zero(kFloats) : slopeAlong<kLayers>(neighbors, x, inv_z);
      hn::StoreU(slopes, kFloats, slope[i] + x);
    }
  }
}

void FindSlopesX(const FiveRows& rows, const ByLayer<float*>& slope) {
  const auto& row = rows.inv_z[2];
  const Neighbors neighbors{row, row, row, row, 1};
  VIEWLOOM_BY_LAYER_COUNT(rows.layer_count, slopesOf, rows, neighbors, slope)
}

void FindSlopesY(const FiveRows& rows, const ByLayer<float*>& slope) {
  const Neighbors neighbors{rows.inv_z[0], rows.inv_z[1], rows.inv_z[3], rows.inv_z[4], 0};
  VIEWLOOM_BY_LAYER_COUNT(rows.layer_count, slopesOf, rows, neighbors, slope)
}

template <uint32_t kLayers>
HWY_INLINE bool edgesOf(const FacetRow& row, const ByLayer<const float*>& slope_y, float dy,
                        const EdgeRow& edges) {
  const Vec zero = hn::Zero(kFloats);
  const Vec nothing = set(abi::kNoSurface);
  Mask falls_below = noLane();
  for (size_t x = 0; x < row.width; x += hn::Lanes(kFloats)) {
    for (uint32_t i = 0; i < kLayers; ++i) {
      const Vec inv_z = loadAt(row.inv_z, i, x, 0);
      const Vec middle = hn::Add(inv_z, hn::Mul(loadAt(slope_y, i, x, 0), set(dy)));
      const Vec lean = hn::Mul(loadAt(row.slope, i, x, 0), set(0.5F));
      const Mask exists = hn::Ge(inv_z, zero);
      const Vec falls_to = hn::Sub(middle, hn::Abs(lean));
      falls_below = hn::Or(falls_below, hn::And(exists, hn::Lt(falls_to, zero)));
      const Vec left = hn::Max(zero, hn::Sub(middle, lean));
      const Vec right = hn::Max(zero, hn::Add(middle, lean));
      hn::StoreU(hn::IfThenElse(exists, left, nothing), kFloats, edges.left[i] + x);
      hn::StoreU(hn::IfThenElse(exists, right, nothing), kFloats, edges.right[i] + x);
    }
  }
  return !hn::AllFalse(kFloats, falls_below);
}

bool FindEdges(const FacetRow& row, const ByLayer<const float*>& slope_y, float dy,
               const EdgeRow& edges){
    VIEWLOOM_BY_LAYER_COUNT(row.layer_count, edgesOf, row, slope_y, dy, edges)}

// Considers all lines through (begin, anchor). Returns the first facet that no line passes within
// the tolerance, counted from `begin`; at most `last`.
uint32_t FindRunEnd(const RunSearch& search, uint32_t begin, float* end_inv_z) {
  const float* const left = search.left;
  const float* const right = search.right;
  const float anchor = left[begin];
  *end_inv_z = right[begin];
  if (begin == search.last) return begin + 1;
  const size_t lanes = hn::Lanes(kFloats);
  const Vec least_apart = set(anchor + search.tolerance);
  const Vec most_apart = set(anchor - search.tolerance);
  float slope_min = right[begin] - anchor - search.tolerance;
  float slope_max = right[begin] - anchor + search.tolerance;
  uint32_t x = begin + 1;
  for (; x <= search.last; x += uint32_t(lanes)) {
    // Slopes to the edges of facets beyond the last say nothing.
    const Mask exists = hn::FirstN(kFloats, search.last + 1 - x);
    const Vec near = hn::LoadU(kFloats, search.inverse + (x - begin));
    const Vec far = hn::LoadU(kFloats, search.inverse + (x + 1 - begin));
    const Vec at_near = hn::LoadU(kFloats, left + x);
    const Vec at_far = hn::LoadU(kFloats, right + x);
    const Vec low = hn::Max(hn::Mul(hn::Sub(at_near, least_apart), near),
                            hn::Mul(hn::Sub(at_far, least_apart), far));
    const Vec high = hn::Min(hn::Mul(hn::Sub(at_near, most_apart), near),
                             hn::Mul(hn::Sub(at_far, most_apart), far));
    const float low_max =
        hn::GetLane(hn::MaxOfLanes(kFloats, hn::IfThenElse(exists, low, set(slope_min))));
    const float high_min =
        hn::GetLane(hn::MinOfLanes(kFloats, hn::IfThenElse(exists, high, set(slope_max))));
    if (HWY_LIKELY(std::max(slope_min, low_max) <= std::min(slope_max, high_min))) {
      slope_min = std::max(slope_min, low_max);
      slope_max = std::min(slope_max, high_min);
      continue;
    }
    HWY_ALIGN float lows[HWY_MAX_BYTES / sizeof(float)];
    HWY_ALIGN float highs[HWY_MAX_BYTES / sizeof(float)];
    hn::Store(low, kFloats, lows);
    hn::Store(high, kFloats, highs);
    for (size_t i = 0; i < lanes; ++i, ++x) {
      if (std::max(slope_min, lows[i]) > std::min(slope_max, highs[i])) break;
      slope_min = std::max(slope_min, lows[i]);
      slope_max = std::min(slope_max, highs[i]);
    }
    break;
  }
  const uint32_t end = std::min(x, search.last + 1);
  if (end > begin + 1) {
    const float slope = 0.5F * (slope_min + slope_max);
    *end_inv_z = std::max(0.0F, anchor + slope * float(end - begin));
  }
  return end;
}

}  // namespace viewloom::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace viewloom {

HWY_EXPORT(FindSlopesX);
HWY_EXPORT(FindSlopesY);
HWY_EXPORT(FindEdges);
HWY_EXPORT(FindRunEnd);

void findSlopesX(const FiveRows& rows, const ByLayer<float*>& slope) {
  HWY_DYNAMIC_DISPATCH(FindSlopesX)(rows, slope);
}

void findSlopesY(const FiveRows& rows, const ByLayer<float*>& slope) {
  HWY_DYNAMIC_DISPATCH(FindSlopesY)(rows, slope);
}

bool findEdges(const FacetRow& row, const ByLayer<const float*>& slope_y, float dy,
               const EdgeRow& edges) {
  return HWY_DYNAMIC_DISPATCH(FindEdges)(row, slope_y, dy, edges);
}

uint32_t findRunEnd(const RunSearch& search, uint32_t begin, float* end_inv_z) {
  return HWY_DYNAMIC_DISPATCH(FindRunEnd)(search, begin, end_inv_z);
}

}  // namespace viewloom
#endif
