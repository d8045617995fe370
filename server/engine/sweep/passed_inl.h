// SPDX-License-Identifier: Apache-2.0
// Where rays of a row pass behind layers, and where they meet the far sides of what they passed,
// for each kind of CPU anew.
#if defined(VIEWLOOM_SERVER_SWEEP_PASSED_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VIEWLOOM_SERVER_SWEEP_PASSED_INL_H_
#undef VIEWLOOM_SERVER_SWEEP_PASSED_INL_H_
#else
#define VIEWLOOM_SERVER_SWEEP_PASSED_INL_H_
#endif

#include <algorithm>
#include <cmath>

#include "sweep/hit_painter_inl.h"
#include "sweep/paint_kernels.h"
#include "sweep/project_inl.h"

HWY_BEFORE_NAMESPACE();
namespace viewloom::HWY_NAMESPACE {

// inv_z of rays where they cross an edge, along p.
struct EdgeLine {
  EdgeLine(const Steps& steps, size_t k, const RowRays& row_rays)
      : rays(row_rays),
        edge(set(steps.edge_px[k])),
        at(hn::Mul(hn::Sub(edge, rays.startPx()), rays.perEyesFrom(0))),
        step(hn::Neg(hn::Mul(rays.stepPx(), rays.perEyesFrom(0)))),
        low(set(steps.low_inv_z[k])),
        high(set(steps.high_inv_z[k])) {}

  // 1/Z at the pixels of a vector from `first` on.
  Vec invZ(int32_t first, Vec p) const {
    const Vec inv_z = rays.areFew()
                          ? hn::Mul(hn::Sub(edge, rays.startsFrom(first)), rays.perEyesFrom(first))
                          : hn::MulAdd(step, p, at);
    return hn::Min(hn::Max(inv_z, low), high);
  }

  const RowRays& rays;
  Vec edge, at, step, low, high;
};

// Both lie on the same line where a ray passes behind two layers at one edge; but for rounding.
constexpr float kSameEdge = 1.0F + 8.0F / 8388608.0F;

// Which of the rays inside are behind all layers before.
HWY_INLINE Mask reaches(const float* passed_before, int32_t first, Vec inv_z, Mask inside) {
  if (passed_before == nullptr) return inside;
  const Vec reach = hn::Mul(hn::Load(kFloats, passed_before + first), set(kSameEdge));
  return hn::And(inside, hn::Le(inv_z, reach));
}

// Which of the rays that passed a silhouette have the far side go on to where they are as far back
// as that: mirrored at the edge, they are over a surface as far back, or beyond the image.
HWY_INLINE Mask reachesAsFar(const SurfaceRow& row, float edge_px, Vec moved_px, Vec far) {
  const Vec mirrored = hn::Floor(hn::Add(set(edge_px), moved_px));
  const Vec last = set(float(row.width_px) - 1);
  Mask goes_on = hn::Or(hn::Lt(mirrored, set(0)), hn::Gt(mirrored, last));
  const IntVec column = hn::ConvertTo(kInts, hn::Min(hn::Max(mirrored, set(0)), last));
  const StepRule& deep = row.deep;
  const Vec apart_max =
      hn::Max(set(deep.least), hn::Mul(set(deep.share), hn::Sub(far, set(deep.from))));
  for (uint32_t i = 0; i < row.layer_count; ++i) {
    const Vec inv_z = hn::GatherIndex(kFloats, row.inv_z[i], column);
    goes_on = hn::Or(goes_on, hn::Le(hn::Abs(hn::Sub(inv_z, far)), apart_max));
  }
  return goes_on;
}

// Where rays first pass behind a layer, and where they meet the far side of what they passed last;
// returns whether any passes. Steps in the order in which rays come to them: who passes one has
// come out from behind those before, or met the far side before that.
HWY_INLINE bool paintPassed(const SurfaceRow& row, const RowRays& rays, const SweepFill& fill,
                            uint32_t layer, SweptRow& swept) {
  const uint32_t lanes = uint32_t(hn::Lanes(kFloats));
  const uint32_t width_px = rays.widthPx();
  const Steps& steps = row.layers[layer].silhouettes[size_t(rays.travel())];
  projectSteps(steps, rays, swept);
  const float* const passed_before = layer == 0 ? nullptr : swept.passed_inv_z[layer - 1].data();
  float* const passed = swept.passed_inv_z[layer].data();
  float* const met = swept.met_inv_z[layer].data();
  uint64_t* const marks = swept.passed_vectors[layer].data();
  for (size_t p = 0; p < width_px; p += lanes) {
    hn::Store(set(-1), kFloats, passed + p);
    hn::Store(set(-1), kFloats, met + p);
  }
  std::fill_n(marks, width_px / (64 * lanes) + 1, uint64_t{0});
  const uint32_t count = swept.covering_count;
  const bool is_endless = fill.planted_fault == SweepFault::kFarSideEndless;
  for (uint32_t i = 0; i < count; ++i) {
    const size_t k = size_t(swept.covering[rays.travel() == Travel::kLeft ? count - 1 - i : i]);
    const EdgeLine line(steps, k, rays);
    forVectors(swept.from[k], swept.to[k], [&](int32_t first, Vec p, Mask inside) {
      const Vec inv_z = line.invZ(first, p);
      // A ray that passes it further up comes out before.
      const Vec behind_px = set(steps.behind_px[k]);
      const Vec meets_up_to = hn::MulAdd(behind_px, hn::Abs(rays.perEyesFrom(first)), line.low);
      const Mask passes = reaches(passed_before, first, inv_z, inside);
      const Vec before = hn::Load(kFloats, passed + first);
      hn::Store(hn::Max(before, hn::IfThenElse(passes, inv_z, before)), kFloats, passed + first);
      const Vec met_before = hn::Load(kFloats, met + first);
      const Mask is_new = hn::And(passes, hn::Le(met_before, inv_z));
      Mask meets = hn::And(is_new, hn::Le(inv_z, meets_up_to));
      if (!hn::AllFalse(kFloats, meets) && !is_endless) {
        const Vec moved_px = hn::Mul(rays.eyesFrom(first), hn::Sub(inv_z, line.low));
        meets = hn::And(meets, reachesAsFar(row, steps.edge_px[k], moved_px, line.low));
      }
      const Vec far = hn::IfThenElse(meets, line.low, set(-1));
      hn::Store(hn::IfThenElse(is_new, far, met_before), kFloats, met + first);
      const uint32_t vector = uint32_t(first) / lanes;
      marks[vector / 64] |= uint64_t{1} << (vector % 64);
    });
  }
  return count > 0;
}

// Takes back what of the nearest layer lies beyond its far side.
HWY_INLINE void dropBeyondFarSide(uint32_t width_px, SweptRow& swept) {
  const float* const met = swept.met_inv_z[0].data();
  float* const inv_z_row = swept.inv_z.data();
  forMarkedVectors(swept.passed_vectors[0].data(), 0, int32_t(width_px),
                   [&](int32_t begin, Vec /*p*/, Mask /*inside*/) {
                     const Vec inv_z = hn::Load(kFloats, inv_z_row + begin);
                     const Mask is_hit = hn::Gt(inv_z, hn::Load(kFloats, met + begin));
                     hn::Store(hn::IfThenElse(is_hit, inv_z, set(-1)), kFloats, inv_z_row + begin);
                   });
}

// Where rays pass behind layers, and where what they hit of each ends: at the far side of it, or of
// a deeper one. Behind a layer that no ray passes, none passes another.
HWY_INLINE void findPassed(const SurfaceRow& row, const RowRays& rays, const SweepFill& fill,
                           SweptRow& swept) {
  for (uint32_t i = 0; i < row.layer_count; ++i) {
    if (!paintPassed(row, rays, fill, i, swept)) break;
    swept.passed_layer_count = i + 1;
  }
  for (uint32_t i = swept.passed_layer_count; i > 1; --i) {
    float* const met = swept.met_inv_z[i - 2].data();
    const float* const met_deeper = swept.met_inv_z[i - 1].data();
    forMarkedVectors(swept.passed_vectors[i - 1].data(), 0, int32_t(rays.widthPx()),
                     [&](int32_t first, Vec /*p*/, Mask /*inside*/) {
                       const Vec here = hn::Load(kFloats, met + first);
                       const Vec deeper = hn::Load(kFloats, met_deeper + first);
                       hn::Store(hn::Max(here, deeper), kFloats, met + first);
                     });
  }
}

}  // namespace viewloom::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard, once for each kind of CPU
