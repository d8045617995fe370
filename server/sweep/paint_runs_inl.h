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

// Runs that fill many px each, of one eye: px side by side in vectors.
HWY_INLINE void paintLongRuns(const Runs& runs, const SweepView& view, float width, SweptRow& swept,
                              const HitPainter& painter) {
  swept.covering_count = 0;
  for (size_t k = 0; k < runs.count; k += hn::Lanes(kFloats)) {
    const RunLanes run = runsFrom(runs, k);
    noteCovering(k, runs.count, columnsOf(run, view, width), swept);
    const RunSlopes slopes = slopesOf(run, view);
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
    painter.paint(swept.from[k], swept.to[k], [&](Vec p) { return crossing.at(p); });
  }
}

// Runs of which few fill more than one px: runs side by side in vectors, at the first px of each.
template <class Crossing>
HWY_INLINE void paintShortRuns(const Runs& runs, const SweepView& view, float width,
                               SweptRow& swept, const HitPainter& painter) {
  swept.covering_count = 0;
  for (size_t k = 0; k < runs.count; k += hn::Lanes(kFloats)) {
    const RunLanes run = runsFrom(runs, k);
    const Columns columns = columnsOf(run, view, width);
    if (!noteCovering(k, runs.count, columns, swept)) continue;
    const Place place = Crossing(run, view).at(hn::ConvertTo(kFloats, columns.from));
    hn::StoreU(place.inv_z, kFloats, swept.inv_z_at.data() + k);
    hn::StoreU(place.texel, kInts, swept.first_texel.data() + k);
  }
  for (uint32_t i = 0; i < swept.covering_count; ++i) {
    const size_t k = size_t(swept.covering[i]);
    const int32_t first = swept.from[k];
    painter.paintPixel(first, swept.inv_z_at[k], swept.first_texel[k]);
    if (first + 1 == swept.to[k]) continue;
    const Crossing crossing(runEverywhere(runs, k), view);
    painter.paint(first + 1, swept.to[k], [&](Vec p) { return crossing.at(p); });
  }
}

HWY_INLINE void paintRuns(const Runs& runs, const SweepView& view, uint32_t width_px,
                          SweptRow& swept, const HitPainter& painter) {
  const float width = float(width_px);
  if (!view.hasOneEye())
    paintShortRuns<RayCrossing>(runs, view, width, swept, painter);
  else if (width_px < runs.count)
    paintShortRuns<LineCrossing>(runs, view, width, swept, painter);
  else
    paintLongRuns(runs, view, width, swept, painter);
}

}  // namespace viewloom::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard, once for each kind of CPU
