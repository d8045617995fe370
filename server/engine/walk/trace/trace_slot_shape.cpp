// SPDX-License-Identifier: Apache-2.0
#include "trace/trace_slot_shape.h"

#include <algorithm>

#include "trace/met_blocks.h"

namespace viewloom {

bool TraceSlotShape::holds(const TraceSlotShape& other) const {
  return width_px >= other.width_px && row_count_max >= other.row_count_max &&
         tile_count_max >= other.tile_count_max && walk_count >= other.walk_count &&
         sample_count >= other.sample_count && lens_point_count >= other.lens_point_count &&
         sums_light >= other.sums_light && met_count >= other.met_count &&
         met_lists_bytes >= other.met_lists_bytes && incomplete_count >= other.incomplete_count &&
         outputs == other.outputs && (reflects || !other.reflects);
}

void TraceSlotShape::include(const TraceSlotShape& other) {
  width_px = std::max(width_px, other.width_px);
  row_count_max = std::max(row_count_max, other.row_count_max);
  tile_count_max = std::max(tile_count_max, other.tile_count_max);
  walk_count = std::max(walk_count, other.walk_count);
  sample_count = std::max(sample_count, other.sample_count);
  lens_point_count = std::max(lens_point_count, other.lens_point_count);
  sums_light = sums_light || other.sums_light;
  met_count = std::max(met_count, other.met_count);
  met_lists_bytes = std::max(met_lists_bytes, other.met_lists_bytes);
  incomplete_count = std::max(incomplete_count, other.incomplete_count);
  reflects = reflects || other.reflects;
}

TraceSlotShape slotShape(const TraceJob& job, uint32_t row_count_max, const TraceOutputs& outputs) {
  const AtlasLayout& layout = *job.layout;
  return {.width_px = layout.size_px.width,
          .row_count_max = row_count_max,
          .tile_count_max = uint32_t(job.tileCount()),
          .walk_count = job.walk_count,
          .sample_count = job.sample_count,
          .lens_point_count = uint32_t(layout.lens_points.size()),
          .sums_light = job.sumsLight(),
          .met_count = job.mayGather() ? job.sample_count : 0,
          .met_lists_bytes = job.mayGather() ? metListsBytes(layout, row_count_max) : 0,
          .incomplete_count = incompleteCount(job, row_count_max),
          .outputs = outputs,
          .reflects = job.reflects()};
}

}  // namespace viewloom
