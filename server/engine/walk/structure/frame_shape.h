// SPDX-License-Identifier: Apache-2.0
// Properties of a frame's source that decide the size of its GPU resources: frames of one shape
// share slots.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "frame/frame.h"

namespace viewloom {

// How colour lies on the device.
enum class ColorStorage : uint8_t {
  kRgba8Srgb,     // opaque sRGB BT.709 as it came, 4 bytes a px
  kRgb16Root,     // roots of light, BT.709, 8 bytes a px: what else is opaque
  kRgba16fLinear  // linear BT.709, premultiplied, 8 bytes a px: everything else
};

// The content of one structure: a source, or a face of a cube map.
struct SourcePart {
  size_t source = 0;
  std::optional<uint32_t> face = std::nullopt;
};

// All of a frame, in the order of its sources.
std::vector<SourcePart> partsOf(const FrameFormat& format);

// Limit over all layers; each sample takes 8 bytes for the means of a reach and 8 for making them.
inline constexpr uint64_t kAveragedSamplesMax = uint64_t{1} << 24;

// Shape of one part. Sizes are those of its structure: for a face, with its apron.
struct FrameShape {
  SizePx depth_px;
  std::vector<SizePx> color_px;  // [layer]
  bool is_cube_face = false;
  bool mirrors = false;  // layers say how they do (LayerPlanes::surface)
  ColorStorage color_storage = ColorStorage::kRgba8Srgb;
  // Decoded planes of all layers in the upload, each aligned: depth, how layers mirror, and colour
  // after it; these two have room for the apron of a face. First without and then with colour.
  uint64_t staged_before_color_bytes = 0;
  uint64_t staged_bytes = 0;

  // Some plane is not of depth's size.
  bool colorIsScaled() const {
    return std::any_of(color_px.begin(), color_px.end(),
                       [&](const SizePx& size_px) { return size_px != depth_px; });
  }
  // Whether walks may look colour up in means (structure/mean_color.h): not of light that is seen
  // through, or of another size than depth; nor of the faces of a cube map, as each would be
  // averaged otherwise, and seams would show; nor where means would take more than 128 MiB.
  bool canAverageColor() const {
    return color_storage != ColorStorage::kRgba16fLinear && !colorIsScaled() && !is_cube_face &&
           depth_px.area() * layerCount() <= kAveragedSamplesMax;
  }
  uint32_t layerCount() const { return uint32_t(color_px.size()); }
  bool operator==(const FrameShape&) const = default;
};

FrameShape shapeOf(const Frame& frame, const SourcePart& part = {});
// Shapes of all parts of a frame.
std::vector<FrameShape> shapesOf(const Frame& frame);
// The same of frames of this format, once they are decoded.
std::vector<FrameShape> shapesOf(const FrameFormat& format);

// Memory that a structure of this shape takes at most, bytes, and that builds take beside it, which
// all of a stream share.
uint64_t structureBytes(const FrameShape& shape);
uint64_t buildBytes(const FrameShape& shape);

// The pinhole of a part, px of its structure.
Camera cameraOf(const FrameFormat& format, const SourcePart& part);

// Where each plane of a part lies in the upload, bytes.
struct StagedPlane {
  uint64_t offset = 0;
  uint64_t size_bytes = 0;
};

struct StagedLayer {
  StagedPlane depth;
  StagedPlane surface;  // empty where the layer mirrors nothing
  StagedPlane color;
};

std::vector<StagedLayer> stagedLayers(const Frame& frame, const SourcePart& part = {});

}  // namespace viewloom
