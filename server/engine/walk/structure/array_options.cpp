// SPDX-License-Identifier: Apache-2.0
#include "structure/array_options.h"

#include <algorithm>

#include "structure/structure_layout.h"

namespace viewloom {
namespace {

// Layers may differ in size: all take the room of the largest.
uint64_t colorLayerBytes(const FrameShape& shape) {
  uint64_t largest_bytes = 0;
  for (const SizePx& color_px : shape.color_px) {
    largest_bytes = std::max(largest_bytes, colorBytes(shape.color_storage, color_px));
  }
  return largest_bytes;
}

LayeredBufferOptions undividedColor(const Device& device, const FrameShape& shape) {
  const uint32_t texel_bytes = texelBytes(shape.color_storage);
  return {.layer_bytes = colorLayerBytes(shape),
          .layer_count = shape.layerCount(),
          .texel_format = texel_bytes == 4 ? TexelFormat::kR32Uint : TexelFormat::kRg32Uint,
          .texel_bytes = texel_bytes,
          .intent =
              writesColorInPlace(device, shape) ? MemoryIntent::kUpload : MemoryIntent::kDeviceOnly,
          .debug_name = "color"};
}

LayeredBufferOptions undividedInvZ(const FrameShape& shape) {
  return {.layer_bytes = structureLayout(shape.depth_px).invZBytes(),
          .layer_count = shape.layerCount(),
          .texel_format = TexelFormat::kR32Float,
          .texel_bytes = 4,
          .debug_name = "inv_z"};
}

LayeredBufferOptions undividedStructure(const FrameShape& shape) {
  return {.layer_bytes = structureLayout(shape.depth_px).layerBytes(),
          .layer_count = shape.layerCount(),
          .texel_format = TexelFormat::kRg32Uint,
          .texel_bytes = 8,
          .has_half_texels = true,
          .debug_name = "structure"};
}

LayeredBufferOptions dividedAsNeeded(LayeredBufferOptions options, const Device& device,
                                     const FrameShape& shape) {
  options.is_divided = mustDivide(device, shape);
  return options;
}

}  // namespace

bool writesColorInPlace(const Device& device, const FrameShape& shape) {
  return device.info().shares_memory && shape.color_storage == ColorStorage::kRgba8Srgb;
}

LayeredBufferOptions colorOptions(const Device& device, const FrameShape& shape) {
  return dividedAsNeeded(undividedColor(device, shape), device, shape);
}

LayeredBufferOptions meanColorOptions(const Device& device, const FrameShape& shape) {
  return dividedAsNeeded({.layer_bytes = shape.depth_px.area() * sizeof(uint32_t),
                          .layer_count = shape.layerCount(),
                          .debug_name = "mean color"},
                         device, shape);
}

LayeredBufferOptions surfaceOptions(const Device& device, const FrameShape& shape) {
  return dividedAsNeeded({.layer_bytes = surfaceBytes(shape.depth_px),
                          .layer_count = shape.layerCount(),
                          .texel_format = TexelFormat::kRg32Uint,
                          .texel_bytes = sizeof(abi::SurfaceTexel),
                          .debug_name = "surface"},
                         device, shape);
}

LayeredBufferOptions invZOptions(const Device& device, const FrameShape& shape) {
  return dividedAsNeeded(undividedInvZ(shape), device, shape);
}

LayeredBufferOptions structureOptions(const Device& device, const FrameShape& shape) {
  LayeredBufferOptions options = undividedStructure(shape);
  // The CPU reads it, too, where it is the device (lens/host_structure.h).
  if (device.info().is_software) options.intent = MemoryIntent::kReadback;
  return dividedAsNeeded(options, device, shape);
}

bool mustDivide(const Device& device, const FrameShape& shape) {
  return LayeredBuffer::mustDivide(device, undividedColor(device, shape)) ||
         LayeredBuffer::mustDivide(device, undividedInvZ(shape)) ||
         LayeredBuffer::mustDivide(device, undividedStructure(shape)) ||
         shape.staged_bytes / sizeof(uint32_t) > device.info().limits.texel_count_max;
}

}  // namespace viewloom
