// SPDX-License-Identifier: Apache-2.0
#include "sweep/link_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sweep/link_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sweep/packed_channels_inl.h"

HWY_BEFORE_NAMESPACE();
namespace viewloom::HWY_NAMESPACE {

// Each operation is rounded alone, as stepAt of shaders/lib/structure/structure_access.glsl.
HWY_INLINE Vec stepAt(const StepRule& rule, Vec nearer) {
  return hn::Max(set(rule.least), hn::Mul(set(rule.share), hn::Sub(nearer, set(rule.from))));
}

HWY_INLINE Mask mayLink(Vec a, Vec b, const StepRule& kappa) {
  const Vec tolerance = stepAt(kappa, hn::Max(a, b));
  return hn::And(hn::Ge(hn::Min(a, b), hn::Zero(kFloats)),
                 hn::Le(hn::Abs(hn::Sub(a, b)), tolerance));
}

constexpr int32_t kNoLayer = int32_t(abi::kLayerCountMax);

// The layer nearest to each value among those of the other side not linked to their own layer.
template <uint32_t kLayers>
HWY_INLINE IntVec nearestFree(Vec value, const Vec* there, const Mask* taken, uint32_t own_layer,
                              const StepRule& kappa) {
  IntVec nearest = hn::Set(kInts, kNoLayer);
  Vec distance_min = set(3.4e38F);
  for (uint32_t i = 0; i < kLayers; ++i) {
    if (i == own_layer) continue;
    const Vec apart = hn::Abs(hn::Sub(value, there[i]));
    const Mask is_nearer =
        hn::And(hn::AndNot(taken[i], hn::Lt(apart, distance_min)), mayLink(value, there[i], kappa));
    distance_min = hn::IfThenElse(is_nearer, apart, distance_min);
    nearest = hn::IfThenElse(hn::RebindMask(kInts, is_nearer), hn::Set(kInts, int32_t(i)), nearest);
  }
  return nearest;
}

// Links across an edge, whose middle the layers meet at `here` and `there`: 1 + layer of the other
// side, or 0.
template <uint32_t kLayers>
HWY_INLINE void linkAcross(const Vec* here, const Vec* there, const StepRule& kappa,
                           IntVec* to_there, IntVec* to_here) {
  Mask taken[kLayers];
  Mask has_free = noLane();
  for (uint32_t i = 0; i < kLayers; ++i) {
    taken[i] = mayLink(here[i], there[i], kappa);
    to_there[i] =
        hn::IfThenElseZero(hn::RebindMask(kInts, taken[i]), hn::Set(kInts, int32_t(i) + 1));
    to_here[i] = to_there[i];
    const Mask is_free = hn::AndNot(taken[i], hn::Ge(here[i], hn::Zero(kFloats)));
    has_free = hn::Or(has_free, is_free);
  }
  if (kLayers == 1 || HWY_LIKELY(hn::AllFalse(kFloats, has_free))) return;
  IntVec wanted[kLayers];
  for (uint32_t i = 0; i < kLayers; ++i) {
    wanted[i] = nearestFree<kLayers>(there[i], here, taken, i, kappa);
  }
  for (uint32_t from = 0; from < kLayers; ++from) {
    const IntVec nearest = nearestFree<kLayers>(here[from], there, taken, from, kappa);
    for (uint32_t to = 0; to < kLayers; ++to) {
      if (to == from) continue;
      const auto is_mutual = hn::And(hn::Eq(nearest, hn::Set(kInts, int32_t(to))),
                                     hn::Eq(wanted[to], hn::Set(kInts, int32_t(from))));
      const auto is_taken = hn::RebindMask(kInts, hn::Or(taken[from], taken[to]));
      const auto is_linked = hn::AndNot(is_taken, is_mutual);
      to_there[from] = hn::IfThenElse(is_linked, hn::Set(kInts, int32_t(to) + 1), to_there[from]);
      to_here[to] = hn::IfThenElse(is_linked, hn::Set(kInts, int32_t(from) + 1), to_here[to]);
    }
  }
}

// A facet `offset` px along its axis; kNoSurface where there is none.
HWY_INLINE Vec facetAt(Vec inv_z, Vec slope, float offset) {
  const Vec at = hn::Max(hn::Zero(kFloats), hn::Add(inv_z, hn::Mul(slope, set(offset))));
  return hn::IfThenElse(hn::Ge(inv_z, hn::Zero(kFloats)), at, set(abi::kNoSurface));
}

// kDeepEdge where a facet without a link is the far side of a deep silhouette.
HWY_INLINE IntVec markDeep(IntVec link, Vec far, Vec near, const StepRule& deep) {
  const Mask is_deep =
      hn::And(hn::Ge(far, hn::Zero(kFloats)), hn::Gt(hn::Sub(near, stepAt(deep, near)), far));
  const auto has_none = hn::Eq(link, hn::Zero(kInts));
  return hn::IfThenElse(hn::And(hn::RebindMask(kInts, is_deep), has_none),
                        hn::Set(kInts, int32_t(abi::kDeepEdge)), link);
}

// Facets on both sides of edges: there, at x + shift.
struct EdgeSides {
  const FacetRow& here;
  const FacetRow& there;
  int shift;
};

// Finds the edges at x. `exists`: whether there is a facet here; and there.
template <uint32_t kLayers>
struct EdgeVectors {
  EdgeVectors(const EdgeSides& sides, size_t x, const SurfaceSteps& steps) {
    for (uint32_t i = 0; i < kLayers; ++i) {
      here[i] = facetAt(loadAt(sides.here.inv_z, i, x, 0), loadAt(sides.here.slope, i, x, 0), 0.5F);
      there[i] = facetAt(loadAt(sides.there.inv_z, i, x, sides.shift),
                         loadAt(sides.there.slope, i, x, sides.shift), -0.5F);
    }
    linkAcross<kLayers>(here, there, steps.kappa, to_there, to_here);
    for (uint32_t i = 0; i < kLayers; ++i) {
      to_there[i] = markDeep(to_there[i], here[i], there[i], steps.deep);
      to_here[i] = markDeep(to_here[i], there[i], here[i], steps.deep);
    }
  }

  Vec here[kLayers];
  Vec there[kLayers];
  IntVec to_there[kLayers];
  IntVec to_here[kLayers];
};

template <uint32_t kLayers>
HWY_INLINE void linkRow(const FacetRow& row, const SurfaceSteps& steps,
                        const ByLayer<uint8_t*>& to_right, const ByLayer<uint8_t*>& to_left) {
  constexpr Bytes kBytes;
  for (uint32_t i = 0; i < kLayers; ++i) {
    to_left[i][0] = row.inv_z[i][0] >= 0 ? uint8_t{0} : uint8_t(i + 1);
  }
  // Behind the last column lies the guard: slopes there are not read, as nothing is there.
  for (size_t x = 0; x < row.width; x += hn::Lanes(kFloats)) {
    const EdgeVectors<kLayers> edges({row, row, 1}, x, steps);
    for (uint32_t i = 0; i < kLayers; ++i) {
      const Vec zero = hn::Zero(kFloats);
      const IntVec own = hn::Set(kInts, int32_t(i) + 1);
      const auto exists_here = hn::RebindMask(kInts, hn::Ge(edges.here[i], zero));
      const auto exists_there = hn::RebindMask(kInts, hn::Ge(edges.there[i], zero));
      hn::StoreU(hn::DemoteTo(kBytes, hn::IfThenElse(exists_here, edges.to_there[i], own)), kBytes,
                 to_right[i] + x);
      hn::StoreU(hn::DemoteTo(kBytes, hn::IfThenElse(exists_there, edges.to_here[i], own)), kBytes,
                 to_left[i] + x + 1);
    }
  }
}

void LinkColumns(const FacetRow& row, const SurfaceSteps& steps, const ByLayer<uint8_t*>& to_right,
                 const ByLayer<uint8_t*>& to_left) {
  VIEWLOOM_BY_LAYER_COUNT(row.layer_count, linkRow, row, steps, to_right, to_left)
}

template <uint32_t kLayers>
HWY_INLINE void linkTwoRows(const FacetRow& above, const FacetRow& below, const SurfaceSteps& steps,
                            const ByLayer<uint8_t*>& to_below, const ByLayer<uint8_t*>& to_above) {
  constexpr Bytes kBytes;
  for (size_t x = 0; x < above.width; x += hn::Lanes(kFloats)) {
    const EdgeVectors<kLayers> edges({above, below, 0}, x, steps);
    for (uint32_t i = 0; i < kLayers; ++i) {
      hn::StoreU(hn::DemoteTo(kBytes, edges.to_there[i]), kBytes, to_below[i] + x);
      hn::StoreU(hn::DemoteTo(kBytes, edges.to_here[i]), kBytes, to_above[i] + x);
    }
  }
}

void LinkRows(const FacetRow& above, const FacetRow& below, const SurfaceSteps& steps,
              const ByLayer<uint8_t*>& to_below, const ByLayer<uint8_t*>& to_above){
    VIEWLOOM_BY_LAYER_COUNT(above.layer_count, linkTwoRows, above, below, steps, to_below,
                            to_above)}

HWY_INLINE WordVec packedBlend(const Channels& here, const Channels& there, Vec share) {
  const auto blend = [&](Vec from, Vec to) {
    return hn::Add(from, hn::Mul(share, hn::Sub(to, from)));
  };
  return packChannels(
      {blend(here.red, there.red), blend(here.green, there.green), blend(here.blue, there.blue)});
}

template <uint32_t kLayers>
HWY_INLINE void blendOf(const TexelRow& row, const StepRule& kappa) {
  const Vec share = set(row.share);
  const float toward = row.is_below ? 0.5F : -0.5F;
  for (size_t x = 0; x < row.here.width; x += hn::Lanes(kFloats)) {
    IntVec to_there[kLayers];
    IntVec to_here[kLayers];
    if (row.share > 0) {
      Vec here[kLayers];
      Vec there[kLayers];
      for (uint32_t i = 0; i < kLayers; ++i) {
        here[i] = facetAt(loadAt(row.here.inv_z, i, x, 0), loadAt(row.here.slope, i, x, 0), toward);
        there[i] =
            facetAt(loadAt(row.there.inv_z, i, x, 0), loadAt(row.there.slope, i, x, 0), -toward);
      }
      linkAcross<kLayers>(here, there, kappa, to_there, to_here);
    }
    for (uint32_t i = 0; i < kLayers; ++i) {
      const WordVec own = hn::LoadU(kWords, row.color_here[i] + x);
      WordVec other = own;
      for (uint32_t k = 0; k < kLayers && row.share > 0; ++k) {
        const auto is_there =
            hn::RebindMask(kWords, hn::Eq(to_there[i], hn::Set(kInts, int32_t(k) + 1)));
        other = hn::IfThenElse(is_there, hn::LoadU(kWords, row.color_there[k] + x), other);
      }
      hn::StoreU(packedBlend(channelsOf<false>(own), channelsOf<false>(other), share), kWords,
                 row.texels[i] + x);
    }
  }
}

void BlendRows(const TexelRow& row, const StepRule& kappa) {
  VIEWLOOM_BY_LAYER_COUNT(row.here.layer_count, blendOf, row, kappa)
}

}  // namespace viewloom::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace viewloom {

HWY_EXPORT(LinkColumns);
HWY_EXPORT(LinkRows);
HWY_EXPORT(BlendRows);

void linkColumns(const FacetRow& row, const SurfaceSteps& steps, const ByLayer<uint8_t*>& to_right,
                 const ByLayer<uint8_t*>& to_left) {
  HWY_DYNAMIC_DISPATCH(LinkColumns)(row, steps, to_right, to_left);
}

void linkRows(const FacetRow& above, const FacetRow& below, const SurfaceSteps& steps,
              const ByLayer<uint8_t*>& to_below, const ByLayer<uint8_t*>& to_above) {
  HWY_DYNAMIC_DISPATCH(LinkRows)(above, below, steps, to_below, to_above);
}

void blendRows(const TexelRow& row, const StepRule& kappa) {
  HWY_DYNAMIC_DISPATCH(BlendRows)(row, kappa);
}

}  // namespace viewloom
#endif
