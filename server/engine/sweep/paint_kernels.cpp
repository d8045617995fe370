// SPDX-License-Identifier: Apache-2.0
#include "sweep/paint_kernels.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "shared/trace_abi.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sweep/paint_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sweep/paint_runs_inl.h"
#include "sweep/passed_inl.h"

HWY_BEFORE_NAMESPACE();
namespace viewloom::HWY_NAMESPACE {

HWY_INLINE void paintBridges(const Steps& bridges, const RowRays& rays, const SweptRow& swept,
                             const HitPainter& painter) {
  for (uint32_t i = 0; i < swept.covering_count; ++i) {
    const size_t k = size_t(swept.covering[i]);
    const EdgeLine line(bridges, k, rays);
    const IntVec texel = hn::Set(kInts, bridges.texel[k]);
    painter.paint(swept.from[k], swept.to[k], [&](int32_t first, Vec p) {
      return Place{line.invZ(first, p), texel};
    });
  }
}

// Fills pixels whose rays never come out again with the deepest layer: the silhouette that the ray
// passed last.
void paintFill(const SurfaceRow& row, const RowRays& rays, const SweepFill& fill, SweptRow& swept) {
  const int32_t lanes = int32_t(hn::Lanes(kFloats));
  for (uint32_t i = 0; i < swept.passed_layer_count; ++i) {
    const Steps& steps = row.layers[i].silhouettes[size_t(rays.travel())];
    const float* const passed_before = i == 0 ? nullptr : swept.passed_inv_z[i - 1].data();
    const float* const met = swept.met_inv_z[i].data();
    projectSteps(steps, rays, swept);
    const float rank = 2 * fill.inv_z_max * (float(i) - float(abi::kLayerCountMax));
    for (uint32_t n = 0; n < swept.covering_count; ++n) {
      const size_t k = size_t(swept.covering[n]);
      if (steps.texel[k] == kNoTexel) continue;
      const EdgeLine line(steps, k, rays);
      const IntVec texel_at_low = hn::Set(kInts, steps.texel[k]);
      const Vec texel_per_inv_z = set(steps.texel_per_inv_z[k]);
      forVectors(swept.from[k], swept.to[k], [&](int32_t first, Vec p, Mask inside) {
        if (swept.block_has_hole[first / lanes] == 0) return;
        const Vec inv_z = line.invZ(first, p);
        const Vec up = hn::Mul(hn::Sub(inv_z, line.low), texel_per_inv_z);
        const IntVec texel = hn::Add(texel_at_low, hn::NearestInt(up));
        float* const ranks = swept.fill_rank.data() + first;
        int32_t* const texels = swept.fill_texel.data() + first;
        const Vec own = hn::Sub(set(rank), inv_z);
        const Vec before = hn::Load(kFloats, ranks);
        const Mask passes = hn::And(reaches(passed_before, first, inv_z, inside),
                                    hn::Gt(inv_z, hn::Load(kFloats, met + first)));
        const Mask is_better = hn::And(passes, hn::Gt(own, before));
        hn::Store(hn::IfThenElse(is_better, own, before), kFloats, ranks);
        hn::Store(hn::IfThenElse(hn::RebindMask(kInts, is_better), texel, hn::Load(kInts, texels)),
                  kInts, texels);
      });
    }
  }
}

// Hits of all layers, and where rays pass behind them; false: behind none.
bool paintLayers(const SurfaceRow& row, const RowRays& rays, const SweepFill& fill,
                 SweptRow& swept) {
  const bool is_dropped = fill.planted_fault == SweepFault::kLayerDropped;
  swept.passed_layer_count = 0;
  if (rays.leaveSource()) findPassed(row, rays, fill, swept);
  const uint32_t hit_count =
      is_dropped ? 1 : std::min(swept.passed_layer_count + 1, row.layer_count);
  for (uint32_t i = 0; i < hit_count; ++i) {
    const LayerSurfaces& layer = row.layers[i];
    const HitPainter painter(swept, i, fill.planted_fault);
    paintRuns(layer.runs, rays, swept, painter);
    if (!rays.leaveSource()) break;
    const Steps& bridges = layer.bridges[size_t(rays.travel())];
    projectSteps(bridges, rays, swept);
    paintBridges(bridges, rays, swept, painter);
    // In one layer only the nearest surface counts. It lies beyond the far side or it does not.
    if (i == 0 && swept.passed_layer_count > 0) dropBeyondFarSide(rays.widthPx(), swept);
  }
  return swept.passed_layer_count > 0;
}

struct RayEnd {
  uint32_t ray_class;
  uint32_t column;
};

// How a ray without a hit ends.
HWY_INLINE RayEnd endOf(const SurfaceRow& row, const SweepView& view, float p) {
  const float u = view.startAt(p);
  const float width = float(row.width_px);
  const uint32_t column = uint32_t(std::min(std::max(u, 0.0F), width - 1));
  if (row.is_outside) return {abi::kClassOutside, column};
  if (u >= 0 && u < width) {
    const bool exists = row.nearest_texel[column] >= 0;
    return {exists ? abi::kClassHidden : abi::kClassEmpty, column};
  }
  // It leaves through a border if it travels towards it.
  const float eye_px_m = view.eyeAt(p);
  const bool leaves = u < 0 ? eye_px_m > 0 : eye_px_m < 0;
  const float inv_z = leaves ? ((u < 0 ? 0 : width) - u) / eye_px_m : 3.4e38F;
  const float border_inv_z = u < 0 ? row.left_inv_z : row.right_inv_z;
  return {inv_z <= border_inv_z ? abi::kClassHidden : abi::kClassOutside, column};
}

// Gives the px of a vector that have no hit what they show.
HWY_INLINE void fillHoles(const SurfaceRow& row, const SweepView& view, const SweepFill& fill,
                          size_t begin, size_t end, SweptRow& swept, Coverage& coverage) {
  for (size_t p = begin; p < end; ++p) {
    if (swept.inv_z[p] >= 0) continue;
    RayEnd ray_end = endOf(row, view, float(p));
    if (swept.has_passed && swept.met_inv_z[0][p] >= 0) ray_end.ray_class = abi::kClassHidden;
    swept.class_of_hole[p] = uint8_t(ray_end.ray_class);
    const int32_t last = row.nearest_texel[ray_end.column];
    if (ray_end.ray_class == abi::kClassHidden) {
      ++coverage.hidden;
      const int32_t fill_texel = swept.fill_texel[p];
      swept.texel[p] = fill_texel == kNoTexel ? last : std::max(fill_texel, kNoTexel);
    } else if (ray_end.ray_class == abi::kClassOutside) {
      ++coverage.outside;
      swept.texel[p] = fill.fills_border ? last : kNoTexel;
    } else {
      ++coverage.empty;
      swept.texel[p] = kNoTexel;
    }
  }
}

HWY_INLINE void clearRow(uint32_t width_px, SweptRow& swept) {
  for (size_t p = 0; p < width_px; p += hn::Lanes(kFloats)) {
    hn::Store(set(-1), kFloats, swept.inv_z.data() + p);
  }
}

HWY_INLINE void clearFill(uint32_t width_px, SweptRow& swept) {
  for (size_t p = 0; p < width_px; p += hn::Lanes(kFloats)) {
    hn::Store(set(-3.4e38F), kFloats, swept.fill_rank.data() + p);
    hn::Store(hn::Set(kInts, kNoTexel), kInts, swept.fill_texel.data() + p);
  }
}

// Counts the hits; returns whether px are left that have none. `passes`: passed_inv_z[0] is set.
HWY_INLINE bool countHits(uint32_t width_px, bool passes, SweptRow& swept, Coverage& coverage) {
  const size_t lanes = hn::Lanes(kFloats);
  const float* const passed = swept.passed_inv_z[0].data();
  size_t hit_count = 0;
  size_t assumed_count = 0;
  for (size_t p = 0; p < width_px; p += lanes) {
    const Vec inv_z = hn::Load(kFloats, swept.inv_z.data() + p);
    const Mask exists = hn::FirstN(kFloats, width_px - p);
    const Mask is_hit = hn::And(hn::Ge(inv_z, set(0)), exists);
    hit_count += hn::CountTrue(kFloats, is_hit);
    swept.block_has_hole[p / lanes] = hn::AllFalse(kFloats, hn::AndNot(is_hit, exists)) ? 0 : 1;
    if (!passes) continue;
    const Mask is_assumed = hn::And(is_hit, hn::Gt(hn::Load(kFloats, passed + p), inv_z));
    assumed_count += hn::CountTrue(kFloats, is_assumed);
  }
  coverage.hit += hit_count - assumed_count;
  coverage.hit_assumed += assumed_count;
  return hit_count < width_px;
}

void PaintRow(const SurfaceRow& row, const SweepView& view, const SweepFill& fill,
              uint32_t width_px, SweptRow& swept, Coverage& coverage) {
  clearRow(width_px, swept);
  const RowRays rays(view, width_px, row.layers[0].runs.count, swept);
  swept.has_passed = !row.is_outside && paintLayers(row, rays, fill, swept);
  if (!countHits(width_px, swept.has_passed, swept, coverage)) return;
  clearFill(width_px, swept);
  if (swept.has_passed) paintFill(row, rays, fill, swept);
  const size_t lanes = hn::Lanes(kFloats);
  for (size_t p = 0; p < width_px; p += lanes) {
    if (swept.block_has_hole[p / lanes] == 0) continue;
    fillHoles(row, view, fill, p, std::min(p + lanes, size_t{width_px}), swept, coverage);
  }
}

}  // namespace viewloom::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace viewloom {

HWY_EXPORT(PaintRow);

void paintRow(const SurfaceRow& row, const SweepView& view, const SweepFill& fill,
              uint32_t width_px, SweptRow& swept, Coverage& coverage) {
  HWY_DYNAMIC_DISPATCH(PaintRow)(row, view, fill, width_px, swept, coverage);
}

}  // namespace viewloom
#endif
