// SPDX-License-Identifier: Apache-2.0
#include "structure/frame_shape.h"

#include <algorithm>

#include "frame/cube_map.h"
#include "frame/limits.h"
#include "structure/mean_color.h"
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

// Size of the structure of a plane, or of a face with its apron.
SizePx structureSize(SizePx plane_px, const SourcePart& part) {
  if (!part.face) return plane_px;
  const SizePx face_px = cubeFaceSize(plane_px);
  return {face_px.width + 2 * abi::kCubeApron_px, face_px.height + 2 * abi::kCubeApron_px};
}

// Bytes of the means of a layer.
uint64_t meanBytes(const FrameShape& shape) {
  return shape.depth_px.area() * sizeof(uint32_t);
}

// A layer of a source as it is decoded.
struct DecodedLayer {
  uint64_t depth_bytes = 0;
  uint64_t color_bytes = 0;
  PlaneEncoding color_encoding = PlaneEncoding::kRgba8;
  bool has_surface = false;
};

std::vector<DecodedLayer> decodedLayers(const Frame& frame, const SourcePart& part) {
  std::vector<DecodedLayer> layers;
  for (const LayerPlanes& planes : frame.sources[part.source]) {
    layers.push_back({.depth_bytes = planes.depth->size(),
                      .color_bytes = planes.color->size(),
                      .color_encoding = planes.color_encoding,
                      .has_surface = planes.surface != nullptr});
  }
  return layers;
}

std::vector<DecodedLayer> decodedLayers(const FrameFormat& format, const SourcePart& part) {
  std::vector<DecodedLayer> layers;
  for (const LayerFormat& layer : format.sources[part.source].layers) {
    const bool is_half = layer.color.encoding == PlaneEncoding::kRgba16f;
    layers.push_back({.depth_bytes = decodedBytes(layer.depth),
                      .color_bytes = decodedBytes(layer.color),
                      .color_encoding = is_half ? PlaneEncoding::kRgba16f : PlaneEncoding::kRgba8,
                      .has_surface = layer.mirrors()});
  }
  return layers;
}

std::vector<StagedLayer> stage(const FrameFormat& format, const SourcePart& part,
                               const std::vector<DecodedLayer>& decoded) {
  const std::vector<LayerFormat>& layers = format.sources[part.source].layers;
  std::vector<StagedLayer> staged(decoded.size());
  uint64_t offset = 0;
  const auto put = [&](StagedPlane& plane, uint64_t size_bytes) {
    plane = {offset, size_bytes};
    offset = alignedEnd(offset, size_bytes);
  };
  for (size_t i = 0; i < decoded.size(); ++i) {
    put(staged[i].depth, decoded[i].depth_bytes / (part.face ? kCubeFaceCount : 1));
  }
  for (size_t i = 0; i < decoded.size(); ++i) {
    const SizePx plane_px = layers[i].depth.size_px;
    if (decoded[i].has_surface) put(staged[i].surface, surfaceBytes(structureSize(plane_px, part)));
  }
  for (size_t i = 0; i < decoded.size(); ++i) {
    const SizePx plane_px = layers[i].color.size_px;
    const uint64_t texel_bytes = decoded[i].color_bytes / plane_px.area();
    put(staged[i].color, texel_bytes * structureSize(plane_px, part).area());
  }
  return staged;
}

FrameShape shapeOf(const FrameFormat& format, const SourcePart& part,
                   const std::vector<DecodedLayer>& decoded) {
  const SourceFormat& source = format.sources[part.source];
  FrameShape shape;
  shape.depth_px = structureSize(source.layers.front().depth.size_px, part);
  shape.is_cube_face = part.face.has_value();
  bool all_plain = format.exposure_ev == 0;
  bool all_opaque = true;
  for (size_t i = 0; i < source.layers.size(); ++i) {
    shape.color_px.push_back(structureSize(source.layers[i].color.size_px, part));
    all_plain = all_plain && isPlainColor(source.layers[i].color, decoded[i].color_encoding);
    all_opaque = all_opaque && source.layers[i].color.alpha == AlphaMode::kOpaque;
  }
  shape.color_storage = all_plain    ? ColorStorage::kRgba8Srgb
                        : all_opaque ? ColorStorage::kRgb16Root
                                     : ColorStorage::kRgba16fLinear;
  const std::vector<StagedLayer> staged = stage(format, part, decoded);
  shape.mirrors = source.mirrors();
  shape.staged_before_color_bytes = staged.front().color.offset;
  shape.staged_bytes = alignedEnd(staged.back().color.offset, staged.back().color.size_bytes);
  return shape;
}

}  // namespace

std::vector<SourcePart> partsOf(const FrameFormat& format) {
  std::vector<SourcePart> parts;
  for (size_t source = 0; source < format.sources.size(); ++source) {
    if (!format.sources[source].is_cube_map) {
      parts.push_back({source});
      continue;
    }
    for (uint32_t face = 0; face < kCubeFaceCount; ++face) parts.push_back({source, face});
  }
  return parts;
}

FrameShape shapeOf(const Frame& frame, const SourcePart& part) {
  return shapeOf(frame.format, part, decodedLayers(frame, part));
}

std::vector<FrameShape> shapesOf(const Frame& frame) {
  std::vector<FrameShape> shapes;
  for (const SourcePart& part : partsOf(frame.format)) shapes.push_back(shapeOf(frame, part));
  return shapes;
}

std::vector<FrameShape> shapesOf(const FrameFormat& format) {
  std::vector<FrameShape> shapes;
  for (const SourcePart& part : partsOf(format)) {
    shapes.push_back(shapeOf(format, part, decodedLayers(format, part)));
  }
  return shapes;
}

Camera cameraOf(const FrameFormat& format, const SourcePart& part) {
  const SourceFormat& source = format.sources[part.source];
  if (!part.face) return source.camera;
  const uint32_t side_px = source.layers.front().depth.size_px.width;
  return cubeFaceCamera(source.camera.pose, *part.face, side_px, abi::kCubeApron_px);
}

std::vector<StagedLayer> stagedLayers(const Frame& frame, const SourcePart& part) {
  return stage(frame.format, part, decodedLayers(frame, part));
}

uint64_t structureBytes(const FrameShape& shape) {
  const StructureLayout layout = structureLayout(shape.depth_px);
  uint64_t total_bytes = 0;
  uint64_t color_bytes = 0;
  for (const SizePx& color_px : shape.color_px) {
    color_bytes = std::max(color_bytes, colorBytes(shape.color_storage, color_px));
  }
  for (uint32_t i = 0; i < shape.layerCount(); ++i) {
    total_bytes += color_bytes;
    if (shape.canAverageColor()) total_bytes += MeanColor::kReachesMax * meanBytes(shape);
    total_bytes += layout.layerBytes();
    if (shape.mirrors) total_bytes += surfaceBytes(shape.depth_px);
  }
  return total_bytes;
}

uint64_t buildBytes(const FrameShape& shape) {
  const uint64_t along_y_bytes = shape.canAverageColor() ? meanBytes(shape) : 0;
  const uint64_t inv_z_bytes = structureLayout(shape.depth_px).invZBytes();
  return shape.staged_bytes + shape.layerCount() * (inv_z_bytes + along_y_bytes);
}

}  // namespace viewloom
