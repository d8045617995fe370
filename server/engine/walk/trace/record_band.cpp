// SPDX-License-Identifier: Apache-2.0
// A band, whole or part by part: what comes before its rays, and what makes planes of their answers
// that can be read.
#include "base/check.h"
#include "gpu/barrier.h"
#include "trace/view_tracer.h"

namespace viewloom {
namespace {

constexpr uint32_t kOpaqueBlack = 0xff000000;

bool hasUnusedPixels(const TraceJob& job) {
  const AtlasLayout& layout = *job.layout;
  return job.hasEyesBeside() || layout.padding_right_px > 0 || layout.padding_top_px > 0 ||
         layout.views.size() < size_t{layout.columns} * layout.rows;
}

// What no view covers is black; every plane is cleared, so that no byte of an older band is left.
void recordClear(Commands commands, const ReadablePlane& plane, uint32_t value) {
  if (!plane.isEmpty()) commands.fill(plane.target(), value);
}

}  // namespace

void ViewTracer::recordBand(Commands commands, std::span<const StructureSlot* const> structures,
                            const TraceJob& job, BandRows rows, TraceSlot& slot, GpuTimer* timer) {
  if (timer) timer->recordBegin(commands, "trace");
  const uint32_t part_count = BandParts(job, rows).count();
  for (uint32_t part = 0; part < part_count; ++part) {
    recordPart(commands, structures, job, rows, part, slot);
  }
  if (timer) timer->recordEnd(commands);
}

void ViewTracer::recordPart(Commands commands, std::span<const StructureSlot* const> structures,
                            const TraceJob& job, BandRows rows, uint32_t part, TraceSlot& slot) {
  const BandParts parts(job, rows);
  if (part == 0) beginBand(commands, structures, job, rows, slot);
  recordSamples(commands, structures, job, rows, parts.at(part), slot);
  if (part + 1 == parts.count()) endBand(commands, slot);
}

void ViewTracer::beginBand(Commands commands, std::span<const StructureSlot* const> structures,
                           const TraceJob& job, BandRows rows, TraceSlot& slot) {
  const AtlasLayout& layout = *job.layout;
  VIEWLOOM_CHECK(
      slot.shape_.width_px >= layout.size_px.width && slot.shape_.row_count_max >= rows.row_count &&
      slot.shape_.tile_count_max >= job.tilesOf(0).size() &&
      slot.shape_.walk_count >= job.walk_count && slot.shape_.sample_count >= job.sample_count &&
      slot.shape_.lens_point_count >= layout.lens_points.size() &&
      (slot.shape_.reflects || !job.reflects()));
  VIEWLOOM_CHECK(structures.size() == job.walk_count);
  slot.band_px_ = {layout.size_px.width, rows.row_count};
  fillParams(structures, job, slot);

  commands.copy(
      slot.upload_, slot.params_,
      {.size_bytes = TraceSlot::lensOffset(job) + std::span(job.layout->lens_points).size_bytes()});
  recordClear(commands, slot.counters_, 0);
  if (hasUnusedPixels(job)) {
    commands.fill(slot.sampleTarget(job), kOpaqueBlack);
    // The second stage of a lens writes px of views alone.
    if (job.mayGather()) {
      commands.fill(slot.rgba(), kOpaqueBlack);
    }
    for (const ReadablePlane* plane : {&slot.depth_, &slot.mask_, &slot.linear_, &slot.records_}) {
      recordClear(commands, *plane, 0);
    }
  }
  recordTransferToCompute(commands);
}

void ViewTracer::endBand(Commands commands, TraceSlot& slot) {
  const uint64_t area_px = slot.band_px_.area();
  const ColorForm form = slot.shape_.outputs.color;
  if (form != ColorForm::kRgba) {
    packer_.record(commands, slot.rgba(), slot.color_.target(), slot.band_px_, form);
  }

  recordComputeToTransfer(commands);
  slot.color_.recordReadback(commands, slot.colorBytes());
  slot.depth_.recordReadback(commands, area_px * sizeof(float));
  slot.mask_.recordReadback(commands, area_px);
  slot.linear_.recordReadback(commands, area_px * 4 * sizeof(float));
  slot.records_.recordReadback(commands, area_px * sizeof(abi::RayRecord));
  slot.counters_.recordReadback(commands, kCounterCount * sizeof(uint32_t));
  recordTransferToHost(commands);
  recordComputeToHost(commands);
}

}  // namespace viewloom
