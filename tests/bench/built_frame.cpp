// SPDX-License-Identifier: Apache-2.0
#include "bench/built_frame.h"

#include <algorithm>
#include <memory>

#include "structure/structure_builder.h"

namespace viewloom::bench {

BuiltFrame::BuiltFrame(const Device& device, const FramePtr& frame)
    : device_(device),
      timeline_(device),
      recorder_(device),
      structure_(device, shapeOf(*frame)),
      tracer_(device) {
  sweep_source_.prepare(frame, workers_);
  structure_.upload(*frame);
  const StructureBuilder builder(device);
  builder.record(recorder_.begin(), structure_, nullptr);
  timeline_.wait(recorder_.submit(timeline_));
}

TraceJob BuiltFrame::jobOf(const DisplaySpec& spec) const {
  const Camera& camera = structure_.sourceCamera();
  const SizePx source_px = structure_.shape().depth_px;
  const StreamDefaults defaults{.source_intrinsics = camera.intrinsics,
                                .source_size_px = source_px,
                                .focal_distance_m = contentFocalDistance(structure_.stats())};
  const auto layout = std::make_shared<const AtlasLayout>(makeAtlasLayout(spec, defaults).value());
  return makeTraceJob(layout, spec, displayPose(spec, camera), camera, source_px);
}

void BuiltFrame::sweep(const TraceJob& job, const SweepPlan& plan, const TraceOutputs& outputs,
                       SweptAtlas& atlas) {
  sweepAtlas({.job = &job,
              .plan = &plan,
              .source = sweep_source_.rowSource(),
              .inv_z_max = float(inv_z_max())},
             outputs, workers_, sweepers_, atlas);
}

void BuiltFrame::walk(const TraceJob& job, uint32_t band_rows, TraceSlot& slot) {
  const uint32_t row_count = job.layout->size_px.height;
  for (uint32_t row = 0; row < row_count; row += band_rows) {
    const BandRows rows{row, std::min(band_rows, row_count - row)};
    tracer_.recordBand(recorder_.begin(), structure_, job, rows, slot, nullptr);
    timeline_.wait(recorder_.submit(timeline_));
  }
}

}  // namespace viewloom::bench
