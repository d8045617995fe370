// SPDX-License-Identifier: Apache-2.0
#include "bench/load_maker.h"

#include <algorithm>
#include <cstring>
#include <memory>
#include <utility>

#include "gpu/walk_under_test.h"
#include "offline/stage_bench.h"

namespace viewloom::bench {
namespace {

abi::MeasuredHead measuredHead(const StructureSlot& slot) {
  abi::MeasuredHead head;
  std::memcpy(&head, slot.measuredReadback().mapped().data(), sizeof head);
  return head;
}

LoadSource sourceOf(const Frame& frame, const StructureImage& image,
                    const abi::MeasuredHead& measured, double inv_z_max) {
  LoadSource source{.size_px = frame.format.sources.front().layers.front().depth.size_px,
                    .inv_z = {},
                    .rgba = {},
                    .kappa = {.least = measured.kappa_abs,
                              .share = measured.kappa_rel,
                              .from = measured.inv_z_base},
                    .inv_z_max = float(inv_z_max)};
  for (const LayerImage& layer : image.layers) source.inv_z.push_back(layer.inv_z);
  for (const LayerPlanes& planes : frame.sources.front()) {
    std::vector<uint32_t>& rgba = source.rgba.emplace_back(planes.color->size() / 4);
    std::memcpy(rgba.data(), planes.color->data(), planes.color->size());
  }
  return source;
}

bool isOneAxis(const TraceJob& job) {
  return std::all_of(job.tiles.begin(), job.tiles.end(), [](const abi::ViewParams& tile) {
    return tile.eye.y == 0 && tile.eye.z == 0 && tile.direction_dx.y == 0 &&
           tile.direction_dx.z == 0 && tile.direction_dy.x == 0 && tile.direction_dy.z == 0;
  });
}

}  // namespace

BenchLoad LoadMaker::make(std::string name, FramePtr frame, const ViewsOf& views_of) const {
  WalkUnderTest walk(device_);
  const std::unique_ptr<StructureSlot> slot = walk.build(*frame);
  const SourceStats stats = slot->stats();
  const SizePx size_px = slot->layout().size_px;
  const auto layout = std::make_shared<AtlasLayout>(views_of({.camera = slot->sourceCamera(),
                                                              .size_px = size_px,
                                                              .stats = stats,
                                                              .miniature = miniature_}));
  DisplaySpec spec;
  spec.tolerance_px = kDefaultTolerance_px;
  BenchLoad load{
      .name = std::move(name),
      .frame = std::move(frame),
      .source = {},
      .job = makeTraceJob(layout, spec, slot->sourceCamera().pose, slot->sourceCamera(), size_px)};
  load.source = sourceOf(*load.frame, walk.readBack(*slot), measuredHead(*slot), stats.inv_z_max);
  load.disparity_span_px = disparitySpanPx(load.job, stats.inv_z_max);
  load.is_one_axis = isOneAxis(load.job);
  return load;
}

}  // namespace viewloom::bench
