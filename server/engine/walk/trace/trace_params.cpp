// SPDX-License-Identifier: Apache-2.0
#include "trace/trace_params.h"

#include <algorithm>
#include <cstring>

#include "picture/ray_sources.h"
#include "shared/lens_abi.h"
#include "trace/band_params.h"

namespace viewloom {
namespace {

constexpr uint64_t kExtrasStride_bytes = 2 * kDescriptorAlignment_bytes;
static_assert(sizeof(abi::TraceExtras) <= kExtrasStride_bytes);

// A part is a walk of a sample: they are counted through the walks of the first sample, then of the
// next. The extras of all parts come first, then the tiles of all, then AtlasLayout::lens_points.
uint32_t partCount(const TraceJob& job) {
  return job.sample_count * job.walk_count;
}

uint64_t extrasOffset(uint32_t part) {
  return part * kExtrasStride_bytes;
}

uint64_t tilesOffset(uint32_t part, uint32_t part_count, size_t tile_count) {
  const uint64_t tiles_bytes = tile_count * sizeof(abi::ViewParams);
  const uint64_t stride = (tiles_bytes + kDescriptorAlignment_bytes - 1) /
                          kDescriptorAlignment_bytes * kDescriptorAlignment_bytes;
  return extrasOffset(part_count) + part * stride;
}

uint64_t lensOffset(const TraceJob& job) {
  return tilesOffset(partCount(job), partCount(job), job.tileCount());
}

abi::TraceExtras describeExtras(const StructureSlot& structure, const TraceJob& job, uint32_t part,
                                const TracedPlanes& planes) {
  const uint32_t walk = part % job.walk_count;
  abi::TraceExtras extras{
      .depth = addressWords(planes.depth),
      .mask = addressWords(planes.mask),
      .linear = addressWords(planes.linear),
      .records = addressWords(planes.records),
      .counters = addressWords(planes.counters),
      .color_size_px = {},
      .color_stride = structure.colorStride(),
      .focal_px = abi::vec2(structure.sourceCamera().intrinsics.focal_px),
      .principal_px = abi::vec2(structure.sourceCamera().intrinsics.principal_px),
      .eye_axes = job.hasEyesBeside() ? job.bounds[walk].eye_axes : abi::EyeAxes{},
      .microlenses = microlensesOf(*job.layout),
      .lenticular = lenticularEyesOf(*job.layout, part / job.walk_count),
      .depth_scale = scaleOf(job.layout->depth_codes.value_or(DepthCodes{})),
      .met = addressWords(job.mayGather() ? planes.met + part * planes.met_stride_bytes : 0),
      .sample_index = part / job.walk_count};
  for (uint32_t i = 0; i < structure.shape().layerCount(); ++i) {
    extras.color_size_px[i] = packSize(structure.shape().color_px[i]);
  }
  return extras;
}

}  // namespace

uint64_t TraceParams::uploadBytesFor(const TraceSlotShape& shape) {
  const uint32_t part_count = shape.sample_count * shape.walk_count;
  return tilesOffset(part_count, part_count, shape.tile_count_max) +
         uint64_t{shape.lens_point_count} * sizeof(abi::vec2);
}

TraceParams::TraceParams(const Device& device, const TraceSlotShape& shape)
    : upload_(device, {.size_bytes = uploadBytesFor(shape),
                       .intent = MemoryIntent::kUpload,
                       .debug_name = "trace upload"}),
      params_(device, {.size_bytes = uploadBytesFor(shape), .debug_name = "trace params"}) {}

void TraceParams::write(std::span<const StructureSlot* const> structures, const TraceJob& job,
                        const TracedPlanes& planes) {
  std::byte* const to = upload_.mapped().data();
  for (uint32_t part = 0; part < partCount(job); ++part) {
    const uint32_t walk = part % job.walk_count;
    const abi::TraceExtras extras = describeExtras(*structures[walk], job, part, planes);
    const std::span<const abi::ViewParams> tiles = job.tilesOf(walk, part / job.walk_count);
    std::memcpy(to + extrasOffset(part), &extras, sizeof extras);
    std::memcpy(to + tilesOffset(part, partCount(job), tiles.size()), tiles.data(),
                tiles.size_bytes());
  }
  // Each sample's point, and those of the second stage after them.
  const auto points = std::as_bytes(std::span(job.layout->lens_points));
  std::ranges::copy(points, to + lensOffset(job));
}

void TraceParams::recordUpload(Commands commands, const TraceJob& job) const {
  const uint64_t points_bytes = std::span(job.layout->lens_points).size_bytes();
  commands.copy(upload_, params_, {.size_bytes = lensOffset(job) + points_bytes});
}

std::vector<Descriptor> TraceParams::of(const TraceJob& job, uint32_t walk, uint32_t sample) const {
  const std::span<const abi::ViewParams> tiles = job.tilesOf(walk, sample);
  const uint32_t part = sample * job.walk_count + walk;
  return {{.binding = abi::kBindingViews,
           .kind = DescriptorKind::kStorage,
           .buffer = &params_,
           .offset_bytes = tilesOffset(part, partCount(job), tiles.size()),
           .size_bytes = tiles.size_bytes()},
          {.binding = abi::kBindingExtras,
           .kind = DescriptorKind::kUniform,
           .buffer = &params_,
           .offset_bytes = extrasOffset(part),
           .size_bytes = sizeof(abi::TraceExtras)}};
}

Descriptor TraceParams::lensPoints(const TraceJob& job, uint32_t sample) const {
  Descriptor points{.binding = abi::kBindingLensPoints,
                    .kind = DescriptorKind::kStorage,
                    .buffer = &params_,
                    .size_bytes = kExtrasStride_bytes};
  if (!job.hasLens()) return points;
  constexpr uint64_t kPoint_bytes = uint64_t{kLensPatternArea_px} * sizeof(abi::vec2);
  static_assert(kPoint_bytes % kDescriptorAlignment_bytes == 0);
  const LensRays& lens = *job.layout->lens;
  const uint32_t point = sample % lens.walked_count;
  points.offset_bytes = lensOffset(job) + point * kPoint_bytes;
  points.size_bytes = (lens.pointCount() - point) * kPoint_bytes;
  return points;
}

}  // namespace viewloom
