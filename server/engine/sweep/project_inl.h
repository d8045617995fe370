// SPDX-License-Identifier: Apache-2.0
// The px of a row of a view that runs and steps of the source cover, for each kind of CPU anew.
#if defined(VIEWLOOM_SERVER_SWEEP_PROJECT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VIEWLOOM_SERVER_SWEEP_PROJECT_INL_H_
#undef VIEWLOOM_SERVER_SWEEP_PROJECT_INL_H_
#else
#define VIEWLOOM_SERVER_SWEEP_PROJECT_INL_H_
#endif

#include "sweep/run_crossing_inl.h"

HWY_BEFORE_NAMESPACE();
namespace viewloom::HWY_NAMESPACE {

// Px [from, to) each.
struct Columns {
  IntVec from, to;
};

HWY_INLINE Columns columnsOf(const RunLanes& run, const RowRays& rays) {
  return {rays.columnOf(run.begin, run.begin_w), rays.columnOf(run.end, run.end_w)};
}

// Notes which pieces from `k` on cover px.
HWY_INLINE void noteCovering(size_t k, size_t count, const Columns& columns, SweptRow& swept) {
  const auto covers = hn::And(hn::Lt(columns.from, columns.to), hn::FirstN(kInts, count - k));
  if (hn::AllFalse(kInts, covers)) return;
  hn::StoreU(columns.from, kInts, swept.from.data() + k);
  hn::StoreU(columns.to, kInts, swept.to.data() + k);
  int32_t* const end = swept.covering.data() + swept.covering_count;
  swept.covering_count += storeThose(kInts, hn::Iota(kInts, int32_t(k)), covers, end);
}

// The px whose rays meet each step.
HWY_INLINE void projectSteps(const Steps& steps, const RowRays& rays, SweptRow& swept) {
  swept.covering_count = 0;
  for (size_t k = 0; k < steps.count; k += hn::Lanes(kFloats)) {
    const Vec edge = hn::LoadU(kFloats, steps.edge_px.data() + k);
    const Vec low = hn::LoadU(kFloats, steps.low_inv_z.data() + k);
    const Vec high = hn::LoadU(kFloats, steps.high_inv_z.data() + k);
    const IntVec at_low = rays.columnOf(edge, low);
    const IntVec at_high = rays.columnOf(edge, high);
    noteCovering(k, steps.count, {hn::Min(at_low, at_high), hn::Max(at_low, at_high)}, swept);
  }
}

}  // namespace viewloom::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard, once for each kind of CPU
