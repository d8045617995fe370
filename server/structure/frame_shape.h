// SPDX-License-Identifier: Apache-2.0
// What of a frame's source decides the size of its GPU resources: those of one shape share slots.
#pragma once

#include <cstdint>
#include <vector>

#include "frame/frame.h"

namespace viewloom {

// How colour lies on the device.
enum class ColorStorage : uint8_t {
  kRgba8Srgb,     // opaque sRGB BT.709 as it came, 4 bytes a px
  kRgb11Root,     // roots of light, BT.709, 4 bytes a px: what else is opaque
  kRgba16fLinear  // linear BT.709, premultiplied, 8 bytes a px: everything else
};

// Of one source.
struct FrameShape {
  SizePx depth_px;
  std::vector<SizePx> color_px;  // [layer]
  ColorStorage color_storage = ColorStorage::kRgba8Srgb;
  // Decoded planes of all layers in the upload, each aligned: depth, and colour after it.
  uint64_t staged_depth_bytes = 0;
  uint64_t staged_bytes = 0;

  uint32_t layerCount() const { return uint32_t(color_px.size()); }
  bool operator==(const FrameShape&) const = default;
};

FrameShape shapeOf(const Frame& frame, size_t source = 0);
// Of all sources of a frame.
std::vector<FrameShape> shapesOf(const Frame& frame);

// Device and host memory one slot of this shape takes at most, bytes; to check before anything is
// allocated.
uint64_t structureBytes(const FrameShape& shape);

// Where each plane of a source lies in the upload, bytes.
struct StagedPlane {
  uint64_t offset = 0;
  uint64_t size_bytes = 0;
};

struct StagedLayer {
  StagedPlane depth;
  StagedPlane color;
};

std::vector<StagedLayer> stagedLayers(const Frame& frame, size_t source = 0);

}  // namespace viewloom
