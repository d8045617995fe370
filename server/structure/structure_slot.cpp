// SPDX-License-Identifier: Apache-2.0
#include "structure/structure_slot.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include <glm/common.hpp>

#include "frame/depth.h"
#include "structure/describe_planes.h"

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

// Where the device's memory is the CPU's, colour that stays as it came is written in its place.
bool writesColorInPlace(const Device& device, const FrameShape& shape) {
  return device.info().shares_memory && shape.color_storage == ColorStorage::kRgba8Srgb;
}

LayeredBufferOptions colorOptions(const Device& device, const FrameShape& shape) {
  const uint32_t texel_bytes = texelBytes(shape.color_storage);
  return {.layer_bytes = colorLayerBytes(shape),
          .layer_count = shape.layerCount(),
          .texel_format = texel_bytes == 4 ? vk::Format::eR32Uint : vk::Format::eR32G32Uint,
          .texel_bytes = texel_bytes,
          .intent =
              writesColorInPlace(device, shape) ? MemoryIntent::kUpload : MemoryIntent::kDeviceOnly,
          .debug_name = "color"};
}

LayeredBufferOptions invZOptions(const FrameShape& shape) {
  return {.layer_bytes = structureLayout(shape.depth_px).invZBytes(),
          .layer_count = shape.layerCount(),
          .texel_format = vk::Format::eR32Sfloat,
          .texel_bytes = 4,
          .debug_name = "inv_z"};
}

LayeredBufferOptions structureOptions(const FrameShape& shape) {
  return {.layer_bytes = structureLayout(shape.depth_px).layerBytes(),
          .layer_count = shape.layerCount(),
          .texel_format = vk::Format::eR32G32Uint,
          .texel_bytes = 8,
          .has_half_texels = true,
          .debug_name = "structure"};
}

bool mustDivide(const Device& device, const FrameShape& shape) {
  return LayeredBuffer::mustDivide(device, colorOptions(device, shape)) ||
         LayeredBuffer::mustDivide(device, invZOptions(shape)) ||
         LayeredBuffer::mustDivide(device, structureOptions(shape)) ||
         shape.staged_bytes / sizeof(uint32_t) > device.info().limits.texel_count_max;
}

LayeredBufferOptions divided(LayeredBufferOptions options, bool is_divided) {
  options.is_divided = is_divided;
  return options;
}

}  // namespace

StructureSlot::StructureSlot(const Device& device, const FrameShape& shape)
    : StructureSlot(device, shape, mustDivide(device, shape)) {}

StructureSlot::StructureSlot(const Device& device, const FrameShape& shape, bool is_divided)
    : shape_(shape),
      layout_(structureLayout(shape.depth_px)),
      color_is_in_place_(writesColorInPlace(device, shape)),
      staging_(device,
               {.size_bytes = color_is_in_place_ ? shape.staged_depth_bytes : shape.staged_bytes,
                .intent = MemoryIntent::kUpload,
                .debug_name = "staged planes"}),
      staging_texels_(is_divided ? TexelView() : TexelView(device, staging_, vk::Format::eR32Uint)),
      depth_planes_upload_(device, {.size_bytes = sizeof(abi::DepthPlanes),
                                    .intent = MemoryIntent::kUpload,
                                    .debug_name = "depth planes"}),
      measured_(device, {.size_bytes = sizeof(abi::Measured), .debug_name = "measured"}),
      measured_readback_(device, {.size_bytes = sizeof(abi::MeasuredHead),
                                  .intent = MemoryIntent::kReadback,
                                  .debug_name = "measured readback"}),
      color_(device, divided(colorOptions(device, shape), is_divided)),
      inv_z_(device, divided(invZOptions(shape), is_divided)),
      structure_(device, divided(structureOptions(shape), is_divided)),
      writes_by_address_(!inv_z_.fitsStorage(device) || !structure_.fitsStorage(device)) {
  staged_.reserve(shape.layerCount());
  conversions_.reserve(shape.layerCount());
}

uint32_t StructureSlot::colorStride() const {
  return uint32_t(color_.layerBytes() / texelBytes(shape_.color_storage));
}

Descriptor StructureSlot::measuredDescriptor() const {
  return {.binding = abi::kBindingMeasured,
          .kind = DescriptorKind::kUniform,
          .buffer = measured_.handle(),
          .size_bytes = sizeof(abi::MeasuredHead)};
}

Descriptor StructureSlot::depthPlanesDescriptor() const {
  return {.binding = abi::kBindingDepthPlanes,
          .kind = DescriptorKind::kUniform,
          .buffer = depth_planes_upload_.handle(),
          .size_bytes = sizeof(abi::DepthPlanes)};
}

Descriptor StructureSlot::stagingDescriptor() const {
  if (staging_texels_.isEmpty()) return structure_.asTexels(abi::kBindingSamples);
  return {.binding = abi::kBindingSamples,
          .kind = DescriptorKind::kTexels,
          .texels = staging_texels_.handle()};
}

void StructureSlot::upload(const Frame& frame, size_t source) {
  staged_ = stagedLayers(frame, source);
  source_camera_ = frame.format.sources[source].camera;
  std::byte* const staging = staging_.mapped().data();
  for (uint32_t i = 0; i < staged_.size(); ++i) {
    const LayerPlanes& planes = frame.sources[source][i];
    std::byte* const color =
        color_is_in_place_ ? color_.mapped(i).data() : staging + staged_[i].color.offset;
    std::memcpy(staging + staged_[i].depth.offset, planes.depth->data(), planes.depth->size());
    std::memcpy(color, planes.color->data(), planes.color->size());
  }
  describe(frame, source);
}

void StructureSlot::describe(const Frame& frame, size_t source_index) {
  const SourceFormat& source = frame.format.sources[source_index];
  const Intrinsics& intrinsics = source.camera.intrinsics;
  depth_planes_ = {.samples = addressWords(staging_.address()),
                   .focal_px = abi::vec2(intrinsics.focal_px),
                   .principal_px = abi::vec2(intrinsics.principal_px),
                   .planes = {}};
  conversions_.clear();
  for (size_t i = 0; i < staged_.size(); ++i) {
    const uint32_t layer = uint32_t(i);
    depth_planes_.planes[i] = describeDepth(source.layers[i].depth, staged_[i].depth.offset);
    abi::ConvertColorPush color =
        describeConversion(source.layers[i].color, frame.sources[source_index][i].color_encoding,
                           frame.format.exposure_ev);
    color.from = addressWords(staging_.address() + staged_[i].color.offset);
    color.to = addressWords(color_.address(layer));
    color.to_format = colorFormat(shape_.color_storage);
    conversions_.push_back(color);
    build_.inv_z[i] = addressWords(inv_z_.address(layer));
    build_.layers[i] = addressWords(structure_.address(layer));
  }
  std::memcpy(depth_planes_upload_.mapped().data(), &depth_planes_, sizeof depth_planes_);
  build_.measured = addressWords(measured_.address());
  build_.width_px = shape_.depth_px.width;
  build_.height_px = shape_.depth_px.height;
  build_.layer_count = shape_.layerCount();
  build_.given_kappa = float(source.connection_tolerance);
  build_.format_step = {};
  for (const LayerFormat& layer : source.layers) {
    build_.format_step = glm::max(build_.format_step, surfaceStep(layer.depth));
  }
}

SourceStats StructureSlot::stats() const {
  abi::MeasuredHead measured;
  std::memcpy(&measured, measured_readback_.mapped().data(), measured_readback_.sizeBytes());
  const bool has_surface = measured.inv_z_min_bits <= measured.inv_z_max_bits;
  return {.depth_step = measured.depth_step,
          .noise_sigma = measured.noise_sigma,
          .connection_tolerance = measured.kappa_abs,
          .bad_samples_count = measured.bad_samples_count,
          .unsorted_columns_count = measured.unsorted_columns_count,
          .inv_z_min = has_surface ? std::bit_cast<float>(measured.inv_z_min_bits) : 0.0F,
          .inv_z_max = has_surface ? std::bit_cast<float>(measured.inv_z_max_bits) : 0.0F,
          .inv_z_near = measured.inv_z_near,
          .inv_z_far = measured.inv_z_far,
          .smoothing_reach = measured.smoothing_reach};
}

}  // namespace viewloom
