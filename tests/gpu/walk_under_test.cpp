// SPDX-License-Identifier: Apache-2.0
#include "gpu/walk_under_test.h"

#include <cstring>
#include <utility>

#include "gpu/barrier.h"

namespace viewloom {
namespace {

SharedBytes bytesOf(const void* from, size_t size_bytes) {
  const auto* bytes = static_cast<const uint8_t*>(from);
  return std::make_shared<const std::vector<uint8_t>>(bytes, bytes + size_bytes);
}

LayerFormat layerFormat(SizePx size_px) {
  LayerFormat layer;
  layer.color = {.kind = PlaneKind::kColor, .encoding = PlaneEncoding::kRgba8, .size_px = size_px};
  layer.depth = {
      .kind = PlaneKind::kDepth, .encoding = PlaneEncoding::kDepthF32, .size_px = size_px};
  layer.depth.depth = {.meaning = DepthMeaning::kDisparity,
                       .invalid_value = double{oracle::kNoSurface}};
  return layer;
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
  const oracle::InvZPlanes& planes = scene.planes;
  const SizePx size_px{uint32_t(planes.width), uint32_t(planes.height)};
  auto frame = std::make_shared<Frame>();
  SourceFormat source;
  source.camera.intrinsics = {scene.pinhole.focal_px, scene.pinhole.principal_px};
  source.connection_tolerance = scene.kappa.relative > 0 ? 0 : double{scene.kappa.absolute};
  std::vector<LayerPlanes> layers;
  const std::vector<uint8_t> color(size_px.area() * 4, 255);
  for (int layer = 0; layer < planes.layer_count; ++layer) {
    source.layers.push_back(layerFormat(size_px));
    layers.push_back({.color = bytesOf(color.data(), color.size()),
                      .depth = bytesOf(&planes.inv_z[planes.index(layer, 0, 0)],
                                       size_px.area() * sizeof(float))});
  }
  frame->format.number = 1;
  frame->format.sources.push_back(std::move(source));
  frame->sources.push_back(std::move(layers));
  return frame;
}

oracle::OracleSource sourceOf(const oracle::Scene& scene, const StructureSlot& slot) {
  const oracle::ConnectionTolerance kappa{float(slot.stats().connection_tolerance),
                                          scene.kappa.relative};
  return {oracle::canonicalPlanes(scene.planes), scene.pinhole, kappa};
}

WalkUnderTest::WalkUnderTest(const Device& device)
    : device_(device), builder_(device), tracer_(device), recorder_(device), timeline_(device) {}

std::unique_ptr<StructureSlot> WalkUnderTest::build(const Frame& frame) {
  auto slot = std::make_unique<StructureSlot>(device_, shapeOf(frame));
  slot->upload(frame);
  builder_.record(recorder_.begin(), *slot, nullptr);
  timeline_.wait(recorder_.submit(timeline_));
  return slot;
}

template <typename Element>
std::vector<Element> WalkUnderTest::read(const Buffer& buffer) {
  const Buffer readback(device_, {.size_bytes = buffer.sizeBytes(),
                                  .intent = MemoryIntent::kReadback,
                                  .debug_name = "structure readback"});
  const vk::CommandBuffer commands = recorder_.begin();
  commands.copyBuffer(buffer.handle(), readback.handle(),
                      vk::BufferCopy{.size = buffer.sizeBytes()});
  recordTransferToHost(commands);
  timeline_.wait(recorder_.submit(timeline_));
  std::vector<Element> elements(buffer.sizeBytes() / sizeof(Element));
  std::memcpy(elements.data(), readback.mapped().data(), elements.size() * sizeof(Element));
  return elements;
}

StructureImage WalkUnderTest::readBack(const StructureSlot& slot) {
  const StructureLayout& layout = slot.layout();
  const auto grid = [](const std::vector<PackedPair>& all, const LevelLayout& level) {
    const auto first = all.begin() + level.offset;
    return NodeGrid{int(level.size.width),
                    int(level.size.height),
                    {first, first + ptrdiff_t(level.size.area())}};
  };
  StructureImage image{.width = int(layout.size_px.width),
                       .height = int(layout.size_px.height),
                       .kappa_abs = float(slot.stats().connection_tolerance)};
  for (const StructureSlot::LayerBuffers& buffers : slot.layers()) {
    LayerImage layer{.inv_z = read<float>(buffers.inv_z),
                     .facets = read<PackedPair>(buffers.facets),
                     .links = read<uint16_t>(buffers.links),
                     .entries = grid(read<PackedPair>(buffers.entries), layout.levels[0])};
    const std::vector<PackedPair> nodes = read<PackedPair>(buffers.nodes);
    for (const LevelLayout& level : layout.levels) layer.levels.push_back(grid(nodes, level));
    image.layers.push_back(std::move(layer));
  }
  return image;
}

std::vector<std::vector<abi::RayRecord>> WalkUnderTest::trace(
    const StructureSlot& slot, const std::vector<oracle::OutputView>& views, double tolerance_px) {
  const auto layout = std::make_shared<const AtlasLayout>(rowOfViews(views));
  DisplaySpec spec;
  spec.tolerance_px = tolerance_px;
  const TraceJob job =
      makeTraceJob(layout, spec, Pose{}, slot.sourceCamera(), slot.shape().depth_px);
  TraceSlot traced(device_, {.width_px = layout->size_px.width,
                             .row_count_max = layout->size_px.height,
                             .tile_count_max = uint32_t(job.tiles.size()),
                             .outputs = {.records = true}});
  tracer_.recordBand(recorder_.begin(), slot, job, {0, layout->size_px.height}, traced, nullptr);
  timeline_.wait(recorder_.submit(timeline_));

  const std::span<const abi::RayRecord> records = traced.records();
  std::vector<std::vector<abi::RayRecord>> by_view(views.size());
  const size_t width = layout->tile_size_px.width;
  for (size_t row = 0; row < layout->size_px.height; ++row) {
    for (size_t view = 0; view < views.size(); ++view) {
      const auto first = records.begin() + ptrdiff_t(row * layout->size_px.width + view * width);
      by_view[view].insert(by_view[view].end(), first, first + ptrdiff_t(width));
    }
  }
  return by_view;
}

}  // namespace viewloom
