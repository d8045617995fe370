// SPDX-License-Identifier: Apache-2.0
#include "gpu/walk_under_test.h"

#include <cstring>
#include <utility>

#include <glm/gtc/packing.hpp>
#include <glm/gtc/type_precision.hpp>

#include "gpu/commands.h"
#include "oracle/smooth_planes.h"

namespace viewloom {
namespace {

SharedBytes bytesOf(const void* from, size_t size_bytes) {
  const auto* bytes = static_cast<const uint8_t*>(from);
  return std::make_shared<const std::vector<uint8_t>>(bytes, bytes + size_bytes);
}

// `color` is repeated over the plane.
template <typename Texel>
SharedBytes filled(SizePx size_px, const Texel& color) {
  const std::vector<Texel> texels(size_px.area(), color);
  return bytesOf(texels.data(), texels.size() * sizeof(Texel));
}

PlaneFormat depthFormat(SizePx size_px) {
  PlaneFormat depth;
  depth.kind = PlaneKind::kDepth;
  depth.encoding = PlaneEncoding::kDepthF32;
  depth.size_px = size_px;
  depth.depth.meaning = DepthMeaning::kDisparity;
  depth.depth.invalid_value = double{oracle::kNoSurface};
  return depth;
}

// A frame whose layers have depth, and colours still to be filled in.
std::shared_ptr<Frame> uncolored(const oracle::Scene& scene) {
  const oracle::InvZPlanes& planes = scene.planes;
  const SizePx size_px{uint32_t(planes.width), uint32_t(planes.height)};
  auto frame = std::make_shared<Frame>();
  frame->format.number = 1;
  SourceFormat& source = frame->format.sources.emplace_back();
  source.camera.intrinsics = {scene.pinhole.focal_px, scene.pinhole.principal_px};
  source.connection_tolerance = scene.kappa.relative > 0 ? 0 : double{scene.kappa.absolute};
  std::vector<LayerPlanes>& layers = frame->sources.emplace_back();
  for (int layer = 0; layer < planes.layer_count; ++layer) {
    LayerFormat& format = source.layers.emplace_back();
    format.depth = depthFormat(size_px);
    format.color.size_px = size_px;
    const float* inv_z = &planes.inv_z[planes.index(layer, 0, 0)];
    layers.emplace_back().depth = bytesOf(inv_z, size_px.area() * sizeof(float));
  }
  return frame;
}

// The cells of a level that cover the image; the array goes on to whole nodes of the last level.
NodeGrid gridOf(const StructureLayout& layout, const std::vector<PackedPair>& cells,
                uint32_t level) {
  const uint32_t shift = level == abi::kLevelEntries ? abi::kLevelFirst : level;
  const auto covering = [&](uint32_t size_px) {
    return int((size_px + (1u << shift) - 1) >> shift);
  };
  NodeGrid grid{covering(layout.size_px.width), covering(layout.size_px.height), {}};
  for (int row = 0; row < grid.height; ++row) {
    const auto first = cells.begin() + ptrdiff_t(layout.levelOffset(level)) +
                       ptrdiff_t(row) * layout.levelSize(level).width;
    grid.nodes.insert(grid.nodes.end(), first, first + grid.width);
  }
  return grid;
}

// Without the guard around the image.
std::vector<float> inImage(SizePx size_px, const std::vector<float>& guarded) {
  std::vector<float> inv_z;
  for (uint32_t row = 0; row < size_px.height; ++row) {
    const uint32_t pitch = abi::invZPitch(size_px.width);
    const auto first = guarded.begin() + ptrdiff_t{abi::invZIndex(pitch, 0, int32_t(row))};
    inv_z.insert(inv_z.end(), first, first + size_px.width);
  }
  return inv_z;
}

AtlasLayout rowOfViews(const std::vector<oracle::OutputView>& views) {
  AtlasLayout layout;
  layout.columns = uint32_t(views.size());
  layout.tile_size_px = {uint32_t(views.front().width), uint32_t(views.front().height)};
  layout.size_px = {layout.columns * layout.tile_size_px.width, layout.tile_size_px.height};
  for (const oracle::OutputView& view : views) {
    layout.views.push_back({{{view.position_m, view.orientation},
                             {view.pinhole.focal_px, view.pinhole.principal_px}}});
  }
  return layout;
}

}  // namespace

FramePtr frameOf(const oracle::Scene& scene) {
  const std::shared_ptr<Frame> frame = uncolored(scene);
  const SizePx size_px = frame->format.sources[0].layers[0].color.size_px;
  constexpr uint32_t kWhite = 0xffffffff;
  for (LayerPlanes& planes : frame->sources[0]) planes.color = filled(size_px, kWhite);
  return frame;
}

FramePtr frameOf(const oracle::Scene& scene, const std::vector<LinearColor>& layer_colors) {
  const std::shared_ptr<Frame> frame = uncolored(scene);
  for (size_t layer = 0; layer < layer_colors.size(); ++layer) {
    PlaneFormat& format = frame->format.sources[0].layers[layer].color;
    format.encoding = PlaneEncoding::kRgba16f;
    format.transfer = ColorTransfer::kLinear;
    format.alpha = AlphaMode::kPremultiplied;
    const LinearColor& color = layer_colors[layer];
    const glm::u16vec4 halves{glm::packHalf1x16(color[0]), glm::packHalf1x16(color[1]),
                              glm::packHalf1x16(color[2]), glm::packHalf1x16(color[3])};
    LayerPlanes& planes = frame->sources[0][layer];
    planes.color = filled(format.size_px, halves);
    planes.color_encoding = PlaneEncoding::kRgba16f;
  }
  return frame;
}

TraceJob jobOf(const std::vector<oracle::OutputView>& views, double tolerance_px,
               const Camera& source_camera, SizePx source_px) {
  const SeenSource source{source_camera, source_px};
  return jobOf(views, tolerance_px, std::span(&source, 1));
}

TraceJob jobOf(const std::vector<oracle::OutputView>& views, double tolerance_px,
               std::span<const SeenSource> sources) {
  DisplaySpec spec;
  spec.tolerance_px = tolerance_px;
  return makeTraceJob(std::make_shared<const AtlasLayout>(rowOfViews(views)), spec, Pose{},
                      sources);
}

oracle::OracleSource sourceOf(const oracle::Scene& scene, const StructureSlot& slot) {
  return sourceOf(scene, slot.stats());
}

oracle::OracleSource sourceOf(const oracle::Scene& scene, const SourceStats& stats) {
  const oracle::Coarseness coarseness = {.reach = float(stats.smoothing_reach),
                                         .step = float(stats.depth_step),
                                         .sigma = float(stats.noise_sigma)};
  return {oracle::smoothedPlanes(oracle::canonicalPlanes(scene.planes), coarseness), scene.pinhole,
          kappaOf(scene, stats)};
}

oracle::ConnectionTolerance kappaOf(const oracle::Scene& scene, const SourceStats& stats) {
  return {.absolute = float(stats.connection_tolerance),
          .relative = scene.kappa.relative,
          .range = {.near = float(stats.inv_z_near), .far = float(stats.inv_z_far)}};
}

std::vector<TracedView> splitByView(const AtlasLayout& layout,
                                    std::span<const abi::RayRecord> records,
                                    std::span<const float> linear) {
  std::vector<TracedView> by_view(layout.views.size());
  const size_t width = layout.tile_size_px.width;
  for (size_t index = 0; index < layout.size_px.area(); ++index) {
    TracedView& view = by_view[index % layout.size_px.width / width];
    view.width = int(width);
    view.records.push_back(records[index]);
    const float* const color = &linear[4 * index];
    view.srgb.push_back({color[0], color[1], color[2], color[3]});
  }
  return by_view;
}

WalkUnderTest::WalkUnderTest(const Device& device)
    : device_(device), builder_(device), tracer_(device), recorder_(device), timeline_(device) {}

std::unique_ptr<StructureSlot> WalkUnderTest::build(const Frame& frame,
                                                    std::optional<uint32_t> old_word) {
  return buildIn(std::make_shared<BuildMemory>(device_, shapeOf(frame)), frame, old_word);
}

std::unique_ptr<StructureSlot> WalkUnderTest::buildIn(BuildMemoryPtr build_memory,
                                                      const Frame& frame,
                                                      std::optional<uint32_t> old_word) {
  auto slot = std::make_unique<StructureSlot>(device_, std::move(build_memory));
  slot->upload(frame);
  const Commands commands = recorder_.begin();
  for (uint32_t layer = 0; old_word && layer < slot->shape().layerCount(); ++layer) {
    for (const LayeredBuffer* arrays : {&slot->invZ(), &slot->structure()}) {
      commands.fill(arrays->buffer(layer), arrays->offsetBytes(layer), arrays->layerBytes(),
                    *old_word);
    }
  }
  builder_.record(commands, *slot, nullptr);
  timeline_.wait(recorder_.submit(timeline_));
  return slot;
}

template <typename Element>
std::vector<Element> WalkUnderTest::read(const LayeredBuffer& arrays, uint32_t layer) {
  const Buffer readback(device_, {.size_bytes = arrays.layerBytes(),
                                  .intent = MemoryIntent::kReadback,
                                  .debug_name = "structure readback"});
  const Commands commands = recorder_.begin();
  commands.copy(arrays.buffer(layer), readback,
                {.from_offset = arrays.offsetBytes(layer), .size_bytes = arrays.layerBytes()});
  recordTransferToHost(commands);
  timeline_.wait(recorder_.submit(timeline_));
  std::vector<Element> elements(arrays.layerBytes() / sizeof(Element));
  std::memcpy(elements.data(), readback.mapped().data(), elements.size() * sizeof(Element));
  return elements;
}

StructureImage WalkUnderTest::readBack(const StructureSlot& slot) {
  const StructureLayout& layout = slot.layout();
  StructureImage image{.width = int(layout.size_px.width), .height = int(layout.size_px.height)};
  for (uint32_t index = 0; index < slot.shape().layerCount(); ++index) {
    const std::vector<PackedPair> cells = read<PackedPair>(slot.structure(), index);
    LayerImage& layer = image.layers.emplace_back();
    layer.inv_z = inImage(layout.size_px, read<float>(slot.invZ(), index));
    layer.facets = gridOf(layout, cells, abi::kLevelFacets);
    layer.entries = gridOf(layout, cells, abi::kLevelEntries);
    for (uint32_t level = abi::kLevelFirst; level <= abi::kLevelLast; ++level) {
      layer.levels.push_back(gridOf(layout, cells, level));
    }
    const std::vector<uint16_t> halves = read<uint16_t>(slot.structure(), index);
    for (uint32_t row = 0; row < layout.size_px.height; ++row) {
      const auto first = halves.begin() + ptrdiff_t(layout.cellCount() * 4) +
                         ptrdiff_t{row} * layout.padded_px.width;
      layer.links.insert(layer.links.end(), first, first + layout.size_px.width);
    }
  }
  return image;
}

std::vector<abi::uvec2> WalkUnderTest::cells(const StructureSlot& slot, uint32_t layer) {
  return read<abi::uvec2>(slot.structure(), layer);
}

std::vector<TracedView> WalkUnderTest::trace(const StructureSlot& slot,
                                             const std::vector<oracle::OutputView>& views,
                                             double tolerance_px) {
  return trace(slot, jobOf(views, tolerance_px, slot.sourceCamera(), slot.shape().depth_px));
}

std::vector<TracedView> WalkUnderTest::trace(const StructureSlot& slot, const TraceJob& job) {
  const AtlasLayout& layout = *job.layout;
  TraceSlot traced(device_, {.width_px = layout.size_px.width,
                             .row_count_max = layout.size_px.height,
                             .tile_count_max = uint32_t(job.tiles.size()),
                             .outputs = {.linear = true, .records = true}});
  tracer_.recordBand(recorder_.begin(), slot, job, {0, layout.size_px.height}, traced, nullptr);
  timeline_.wait(recorder_.submit(timeline_));
  return splitByView(layout, traced.records(), traced.linear());
}

}  // namespace viewloom
