// SPDX-License-Identifier: Apache-2.0
// Paints the runs of a layer on a row of a view, for each kind of CPU anew.
#if defined(VIEWLOOM_SERVER_SWEEP_PAINT_RUNS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VIEWLOOM_SERVER_SWEEP_PAINT_RUNS_INL_H_
#undef VIEWLOOM_SERVER_SWEEP_PAINT_RUNS_INL_H_
#else
#define VIEWLOOM_SERVER_SWEEP_PAINT_RUNS_INL_H_
#endif

#include "sweep/hit_painter_inl.h"
#include "sweep/project_inl.h"

HWY_BEFORE_NAMESPACE();
namespace viewloom::HWY_NAMESPACE {

// Many px, of one eye: what is worked out for a run serves all of its own.
HWY_INLINE void paintMany(const Runs& runs, const RowRays& rays, SweptRow& swept,
                          const HitPainter& painter) {
  swept.covering_count = 0;
  for (size_t k = 0; k < runs.count; k += hn::Lanes(kFloats)) {
    const RunLanes run = runsFrom(runs, k);
    noteCovering(k, runs.count, columnsOf(run, rays), swept);
    const RunSlopes slopes = slopesOf(run, rays);
    hn::StoreU(slopes.inv_z_at, kFloats, swept.inv_z_at.data() + k);
    hn::StoreU(slopes.inv_z_step, kFloats, swept.inv_z_step.data() + k);
    hn::StoreU(slopes.texel_at, kFloats, swept.texel_at.data() + k);
    hn::StoreU(slopes.texel_step, kFloats, swept.texel_step.data() + k);
  }
  for (uint32_t i = 0; i < swept.covering_count; ++i) {
    const size_t k = size_t(swept.covering[i]);
    const RunSlopes slopes = {set(swept.inv_z_at[k]), set(swept.inv_z_step[k]),
                              set(swept.texel_at[k]), set(swept.texel_step[k])};
    const LineCrossing crossing(runEverywhere(runs, k), slopes);
    painter.paint(swept.from[k], swept.to[k],
                  [&](int32_t /*first*/, Vec p) { return crossing.at(p); });
  }
}

// Few px, of any eyes.
HWY_INLINE void paintFew(const Runs& runs, const RowRays& rays, SweptRow& swept,
                         const HitPainter& painter) {
  swept.covering_count = 0;
  for (size_t k = 0; k < runs.count; k += hn::Lanes(kFloats)) {
    noteCovering(k, runs.count, columnsOf(runsFrom(runs, k), rays), swept);
  }
  for (uint32_t i = 0; i < swept.covering_count; ++i) {
    const size_t k = size_t(swept.covering[i]);
    const RayCrossing crossing(runEverywhere(runs, k), rays);
    painter.paint(swept.from[k], swept.to[k],
                  [&](int32_t first, Vec /*p*/) { return crossing.from(first); });
  }
}

HWY_INLINE void paintRuns(const Runs& runs, const RowRays& rays, SweptRow& swept,
                          const HitPainter& painter) {
  if (rays.areFew())
    paintFew(runs, rays, swept, painter);
  else
    paintMany(runs, rays, swept, painter);
}

}  // namespace viewloom::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard, once for each kind of CPU
