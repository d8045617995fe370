// SPDX-License-Identifier: Apache-2.0
#include "structure/frame_shape.h"

#include <algorithm>

#include "structure/structure_layout.h"

namespace viewloom {
namespace {

// Planes start at multiples of this: enough for every texel type and for vkCmdCopyBuffer.
constexpr uint64_t kStagingAlignment_bytes = 256;

uint64_t alignedEnd(uint64_t offset, uint64_t size_bytes) {
  const uint64_t end = offset + size_bytes;
  return (end + kStagingAlignment_bytes - 1) / kStagingAlignment_bytes * kStagingAlignment_bytes;
}

bool isPlainColor(const PlaneFormat& color, PlaneEncoding decoded_encoding) {
  return decoded_encoding == PlaneEncoding::kRgba8 && color.transfer == ColorTransfer::kSrgb &&
         color.primaries == ColorPrimaries::kBt709 && color.alpha == AlphaMode::kOpaque;
}

}  // namespace

FrameShape shapeOf(const Frame& frame, size_t source_index) {
  const SourceFormat& source = frame.format.sources[source_index];
  const std::vector<LayerPlanes>& planes = frame.sources[source_index];
  FrameShape shape;
  shape.depth_px = source.layers.front().depth.size_px;
  bool all_plain = frame.format.exposure_ev == 0;
  bool all_opaque = true;
  for (size_t i = 0; i < source.layers.size(); ++i) {
    shape.color_px.push_back(source.layers[i].color.size_px);
    all_plain = all_plain && isPlainColor(source.layers[i].color, planes[i].color_encoding);
    all_opaque = all_opaque && source.layers[i].color.alpha == AlphaMode::kOpaque;
  }
  shape.color_storage = all_plain    ? ColorStorage::kRgba8Srgb
                        : all_opaque ? ColorStorage::kRgb11Root
                                     : ColorStorage::kRgba16fLinear;
  const std::vector<StagedLayer> staged = stagedLayers(frame, source_index);
  shape.staged_depth_bytes = alignedEnd(staged.back().depth.offset, staged.back().depth.size_bytes);
  shape.staged_bytes = alignedEnd(staged.back().color.offset, staged.back().color.size_bytes);
  return shape;
}

std::vector<FrameShape> shapesOf(const Frame& frame) {
  std::vector<FrameShape> shapes;
  for (size_t source = 0; source < frame.sources.size(); ++source) {
    shapes.push_back(shapeOf(frame, source));
  }
  return shapes;
}

std::vector<StagedLayer> stagedLayers(const Frame& frame, size_t source) {
  const std::vector<LayerPlanes>& layers = frame.sources[source];
  std::vector<StagedLayer> staged(layers.size());
  uint64_t offset = 0;
  const auto stage = [&](StagedPlane& plane, uint64_t size_bytes) {
    plane = {offset, size_bytes};
    offset = alignedEnd(offset, size_bytes);
  };
  for (size_t i = 0; i < layers.size(); ++i) stage(staged[i].depth, layers[i].depth->size());
  for (size_t i = 0; i < layers.size(); ++i) stage(staged[i].color, layers[i].color->size());
  return staged;
}

uint64_t structureBytes(const FrameShape& shape) {
  const StructureLayout layout = structureLayout(shape.depth_px);
  uint64_t total_bytes = shape.staged_bytes;
  uint64_t color_bytes = 0;
  for (const SizePx& color_px : shape.color_px) {
    color_bytes = std::max(color_bytes, colorBytes(shape.color_storage, color_px));
  }
  for (uint32_t i = 0; i < shape.layerCount(); ++i) {
    total_bytes += color_bytes;
    total_bytes += layout.layerBytes() + layout.invZBytes();
  }
  return total_bytes;
}

}  // namespace viewloom
