// SPDX-License-Identifier: Apache-2.0
#include "sweep/edge_blends.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "shared/trace_abi.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sweep/edge_blends.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sweep/vectors_inl.h"

HWY_BEFORE_NAMESPACE();
namespace viewloom::HWY_NAMESPACE {

// Texels between a px and the edge of what it shows: kEdgeColumnsMax of
// shaders/lib/light/edge_blend.glsl.
constexpr int32_t kEdgeReach = int32_t(abi::kEdgeColumnsMax) * kSubtexelSteps;

// Notes the edges that lie between two px of the row, and where: swept.covering_count of them, in
// swept.covering which, in swept.from the px on the near side, in swept.inv_z_at how far from it
// the edge is, px.
HWY_INLINE void projectEdges(const Steps& steps, Travel travel, const SweepView& view,
                             uint32_t width_px, SweptRow& swept) {
  const bool is_right_end = travel == Travel::kLeft;
  const Vec last = set(float(width_px) - 1);
  swept.covering_count = 0;
  for (size_t k = 0; k < steps.count; k += hn::Lanes(kFloats)) {
    const Vec edge = hn::LoadU(kFloats, steps.edge_px.data() + k);
    const Vec near = hn::LoadU(kFloats, steps.high_inv_z.data() + k);
    const Vec u = hn::NegMulAdd(set(view.eye_px_m), near, edge);
    const Vec p = hn::Mul(hn::Sub(u, set(view.start_px)), set(1 / view.step_px));
    const Vec own = is_right_end ? hn::Floor(p) : hn::Ceil(p);
    const Vec other = is_right_end ? hn::Add(own, set(1)) : hn::Sub(own, set(1));
    const Mask inside =
        hn::And(hn::Ge(hn::Min(own, other), set(0)), hn::Le(hn::Max(own, other), last));
    const auto exists =
        hn::And(hn::RebindMask(kInts, inside),
                hn::Gt(hn::LoadU(kInts, steps.near_texel.data() + k), hn::Set(kInts, -1)));
    const auto counts = hn::And(exists, hn::FirstN(kInts, steps.count - k));
    const size_t at = swept.covering_count;
    const Vec apart = hn::Abs(hn::Sub(p, own));
    storeThose(kFloats, apart, hn::RebindMask(kFloats, counts), swept.inv_z_at.data() + at);
    storeThose(kInts, hn::ConvertTo(kInts, own), counts, swept.from.data() + at);
    swept.covering_count +=
        storeThose(kInts, hn::Iota(kInts, int32_t(k)), counts, swept.covering.data() + at);
  }
}

// Whether a px shows the surface that ends at the edge, not too far from it. Places among the
// texels of a surface, and of no other, are those in the source, moved.
bool showsSurfaceOf(const Steps& steps, size_t edge, Travel travel, const SweepView& view,
                    const SweptRow& swept, int32_t px) {
  const float inv_z = swept.inv_z[size_t(px)];
  if (inv_z < 0) return false;
  const float place_px = view.start_px + view.step_px * float(px) + view.eye_px_m * inv_z;
  const float end_px = steps.edge_px[edge] + (travel == Travel::kLeft ? -0.5F : 0.5F);
  const int32_t texel_from_end = swept.texel[size_t(px)] - steps.near_texel[edge];
  const float from_end = kSubtexelSteps * (place_px - end_px);
  return std::abs(from_end - float(texel_from_end)) < kSubtexelSteps / 2 &&
         std::abs(texel_from_end) <= kEdgeReach;
}

// Blends the visible ones of the noted edges: the near pixel shows the surface that ends there, and
// the pixel beyond it shows something further back.
void blendSeen(const SurfaceRow& row, const Steps& steps, Travel travel, const SweepView& view,
               SweptRow& swept) {
  for (uint32_t i = 0; i < swept.covering_count; ++i) {
    const int32_t own = swept.from[i];
    const int32_t other = travel == Travel::kLeft ? own + 1 : own - 1;
    if (swept.inv_z[size_t(other)] >= swept.inv_z[size_t(own)]) continue;
    const size_t edge = size_t(swept.covering[i]);
    if (!showsSurfaceOf(steps, edge, travel, view, swept, own)) continue;
    if (showsSurfaceOf(steps, edge, travel, view, swept, other)) continue;
    const float apart = swept.inv_z_at[i];
    if (apart < 0.5F)
      swept.blends.add({.px = own, .other = other, .share = row.clean * (0.5F - apart)});
    else
      swept.blends.add({.px = other, .other = own, .share = row.clean * (apart - 0.5F)});
  }
}

void FindEdgeBlends(const SurfaceRow& row, const SweepView& view, uint32_t width_px,
                    SweptRow& swept) {
  for (uint32_t i = 0; i < row.layer_count; ++i) {
    for (const Travel travel : {Travel::kLeft, Travel::kRight}) {
      const Steps& steps = row.layers[i].silhouettes[size_t(travel)];
      projectEdges(steps, travel, view, width_px, swept);
      blendSeen(row, steps, travel, view, swept);
    }
  }
}

}  // namespace viewloom::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace viewloom {
namespace {

uint32_t blendOfBytes(uint32_t a, uint32_t b, float share) {
  uint32_t blend = 0xff000000U;
  for (const int shift : {0, 8, 16}) {
    const float from = float(a >> shift & 0xffU);
    const float to = float(b >> shift & 0xffU);
    blend |= uint32_t(from + share * (to - from) + 0.5F) << shift;
  }
  return blend;
}

}  // namespace

HWY_EXPORT(FindEdgeBlends);

void findEdgeBlends(const SurfaceRow& row, const SweepView& view, uint32_t width_px,
                    SweptRow& swept) {
  swept.blends.count = 0;
  // From its own place a source shows its own coverage.
  if (row.is_outside || view.eye_px_m == 0) return;
  HWY_DYNAMIC_DISPATCH(FindEdgeBlends)(row, view, width_px, swept);
}

void applyEdgeBlends(EdgeBlends& blends, uint32_t* rgba) {
  // With the colours from before all of them.
  for (uint32_t i = 0; i < blends.count; ++i) {
    blends.other_color[i] = rgba[blends.at[i].other];
  }
  for (uint32_t i = 0; i < blends.count; ++i) {
    uint32_t& color = rgba[blends.at[i].px];
    color = blendOfBytes(color, blends.other_color[i], blends.at[i].share);
  }
}

}  // namespace viewloom
#endif
