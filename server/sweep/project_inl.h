// SPDX-License-Identifier: Apache-2.0
// The px of a row of a view that runs and steps of the source cover, for each kind of CPU anew.
#if defined(VIEWLOOM_SERVER_SWEEP_PROJECT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VIEWLOOM_SERVER_SWEEP_PROJECT_INL_H_
#undef VIEWLOOM_SERVER_SWEEP_PROJECT_INL_H_
#else
#define VIEWLOOM_SERVER_SWEEP_PROJECT_INL_H_
#endif

#include "sweep/swept_row.h"
#include "sweep/vectors_inl.h"

HWY_BEFORE_NAMESPACE();
namespace viewloom::HWY_NAMESPACE {

// Of each px p.
HWY_INLINE Vec eyesAt(const SweepView& view, Vec p) {
  return hn::MulAdd(set(view.eye_step_px_m), p, set(view.eye_px_m));
}

// Where the ray of a px is at inv_z 0 if that of px 0 is at x at inv_z w.
HWY_INLINE Vec startOf(const SweepView& view, Vec x, Vec inv_z) {
  return hn::NegMulAdd(set(view.eye_px_m), inv_z, x);
}

// The first px whose place at inv_z is not below one, within the row: given startOf() it.
HWY_INLINE IntVec columnOf(Vec u, Vec inv_z, const SweepView& view, float width) {
  const Vec beside = hn::Sub(u, set(view.start_px));
  Vec p = hn::Mul(beside, set(1 / view.step_px));
  if (view.hasMovingEye()) {
    p = hn::Div(beside, hn::MulAdd(set(view.eye_step_px_m), inv_z, set(view.step_px)));
  }
  const Vec inside = hn::Min(hn::Max(hn::Ceil(p), set(0)), set(width));
  return hn::ConvertTo(kInts, inside);
}

// Notes which pieces from `k` on cover px, [from, to) each.
HWY_INLINE void noteCovering(size_t k, size_t count, IntVec from, IntVec to, SweptRow& swept) {
  hn::StoreU(from, kInts, swept.from.data() + k);
  hn::StoreU(to, kInts, swept.to.data() + k);
  const auto covers = hn::And(hn::Lt(from, to), hn::FirstN(kInts, count - k));
  int32_t* const end = swept.covering.data() + swept.covering_count;
  swept.covering_count += storeThose(kInts, hn::Iota(kInts, int32_t(k)), covers, end);
}

// The px that each run covers, and its line and texels over them: at + step p; not for moving eyes.
HWY_INLINE void projectRuns(const Runs& runs, const SweepView& view, float width, SweptRow& swept) {
  swept.covering_count = 0;
  for (size_t k = 0; k < runs.count; k += hn::Lanes(kFloats)) {
    const Vec begin = hn::LoadU(kFloats, runs.begin_px.data() + k);
    const Vec end = hn::LoadU(kFloats, runs.end_px.data() + k);
    const Vec begin_w = hn::LoadU(kFloats, runs.begin_inv_z.data() + k);
    const Vec end_w = hn::LoadU(kFloats, runs.end_inv_z.data() + k);
    const Vec u = startOf(view, begin, begin_w);
    const Vec u_end = startOf(view, end, end_w);
    noteCovering(k, runs.count, columnOf(u, begin_w, view, width),
                 columnOf(u_end, end_w, view, width), swept);
    if (view.hasMovingEye()) continue;
    // Along u, of what faces the rays.
    const Vec per_u = hn::Div(set(1), hn::Sub(u_end, u));
    const Vec x_per_u = hn::Mul(hn::Sub(end, begin), per_u);
    const Vec w_per_u = hn::Mul(hn::Sub(end_w, begin_w), per_u);
    const Vec first = hn::Sub(set(view.start_px), u);
    hn::StoreU(hn::MulAdd(w_per_u, first, begin_w), kFloats, swept.inv_z_at.data() + k);
    hn::StoreU(hn::Mul(w_per_u, set(view.step_px)), kFloats, swept.inv_z_step.data() + k);
    hn::StoreU(hn::Mul(hn::MulAdd(x_per_u, first, begin), set(kSubtexelSteps)), kFloats,
               swept.texel_at.data() + k);
    hn::StoreU(hn::Mul(x_per_u, set(kSubtexelSteps * view.step_px)), kFloats,
               swept.texel_step.data() + k);
  }
}

// The px whose rays meet each step.
HWY_INLINE void projectSteps(const Steps& steps, const SweepView& view, float width,
                             SweptRow& swept) {
  swept.covering_count = 0;
  for (size_t k = 0; k < steps.count; k += hn::Lanes(kFloats)) {
    const Vec edge = hn::LoadU(kFloats, steps.edge_px.data() + k);
    const Vec low = hn::LoadU(kFloats, steps.low_inv_z.data() + k);
    const Vec high = hn::LoadU(kFloats, steps.high_inv_z.data() + k);
    const IntVec at_low = columnOf(startOf(view, edge, low), low, view, width);
    const IntVec at_high = columnOf(startOf(view, edge, high), high, view, width);
    noteCovering(k, steps.count, hn::Min(at_low, at_high), hn::Max(at_low, at_high), swept);
  }
}

}  // namespace viewloom::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard, once for each kind of CPU
