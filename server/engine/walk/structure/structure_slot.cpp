// SPDX-License-Identifier: Apache-2.0
#include "structure/structure_slot.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>
#include <utility>

#include <glm/common.hpp>

#include "base/check.h"
#include "frame/cube_map.h"
#include "frame/depth.h"
#include "shared/histogram.h"
#include "structure/array_options.h"
#include "structure/describe_planes.h"

namespace viewloom {
namespace {

// A face of the stacked ones, into a plane with room for an apron around it.
void copyWithinApron(std::span<const uint8_t> faces, uint32_t face, SizePx with_apron_px,
                     std::byte* to) {
  const size_t side_px = with_apron_px.width - 2 * abi::kCubeApron_px;
  const size_t texel_bytes = faces.size() / (kCubeFaceCount * side_px * side_px);
  const size_t row_bytes = side_px * texel_bytes;
  for (size_t row = 0; row < side_px; ++row) {
    const size_t first_px = (row + abi::kCubeApron_px) * with_apron_px.width + abi::kCubeApron_px;
    std::memcpy(to + first_px * texel_bytes, &faces[(face * side_px + row) * row_bytes], row_bytes);
  }
}

// Gives the apron the texels of the nearest pixels of the face.
void fillApronFromWithin(SizePx with_apron_px, abi::SurfaceTexel* texels) {
  const uint32_t last_px = with_apron_px.width - abi::kCubeApron_px - 1;
  const auto within = [&](uint32_t place) {
    return std::clamp(place, abi::kCubeApron_px, last_px);
  };
  for (uint32_t y = 0; y < with_apron_px.height; ++y) {
    for (uint32_t x = 0; x < with_apron_px.width; ++x) {
      if (within(x) == x && within(y) == y) continue;
      texels[y * with_apron_px.width + x] = texels[within(y) * with_apron_px.width + within(x)];
    }
  }
}

void copySurface(const std::vector<uint8_t>& surface, const SourcePart& part, SizePx size_px,
                 std::byte* to) {
  if (!part.face) {
    std::memcpy(to, surface.data(), surface.size());
    return;
  }
  copyWithinApron(surface, *part.face, size_px, to);
  fillApronFromWithin(size_px, reinterpret_cast<abi::SurfaceTexel*>(to));
}

}  // namespace

StructureSlot::StructureSlot(const Device& device, BuildMemoryPtr build_memory)
    : shape_(build_memory->shape()),
      build_memory_(std::move(build_memory)),
      layout_(structureLayout(shape_.depth_px)),
      color_is_in_place_(writesColorInPlace(device, shape_)),
      depth_planes_upload_(device, {.size_bytes = sizeof(abi::DepthPlanes),
                                    .intent = MemoryIntent::kUpload,
                                    .debug_name = "depth planes"}),
      measured_(device, {.size_bytes = sizeof(abi::Measured), .debug_name = "measured"}),
      measured_readback_(device, {.size_bytes = offsetof(abi::Measured, noise_histogram),
                                  .intent = MemoryIntent::kReadback,
                                  .debug_name = "measured readback"}),
      color_(device, colorOptions(device, shape_)),
      mean_color_(std::make_unique<MeanColor>(device, meanColorOptions(device, shape_))),
      surface_(shape_.mirrors
                   ? std::make_unique<LayeredBuffer>(device, surfaceOptions(device, shape_))
                   : nullptr),
      structure_(device, structureOptions(device, shape_)),
      writes_by_address_(!invZ().fitsStorage(device) || !structure_.fitsStorage(device)) {
  staged_.reserve(shape_.layerCount());
  conversions_.reserve(shape_.layerCount());
}

StructureSlot::StructureSlot(const Device& device, const FrameShape& shape)
    : StructureSlot(device, std::make_shared<BuildMemory>(device, shape)) {}

void StructureSlot::buildIn(BuildMemoryPtr build_memory) {
  VIEWLOOM_CHECK(build_memory->shape() == shape_);
  build_memory_ = std::move(build_memory);
}

uint32_t StructureSlot::colorStride() const {
  return uint32_t(color_.layerBytes() / texelBytes(shape_.color_storage));
}

Descriptor StructureSlot::measuredDescriptor() const {
  return {.binding = abi::kBindingMeasured,
          .kind = DescriptorKind::kUniform,
          .buffer = &measured_,
          .size_bytes = sizeof(abi::MeasuredHead)};
}

Descriptor StructureSlot::depthPlanesDescriptor() const {
  return {.binding = abi::kBindingDepthPlanes,
          .kind = DescriptorKind::kUniform,
          .buffer = &depth_planes_upload_,
          .size_bytes = sizeof(abi::DepthPlanes)};
}

Descriptor StructureSlot::stagingDescriptor() const {
  const TexelView& texels = build_memory_->stagingTexels();
  if (texels.isEmpty()) return structure_.asTexels(abi::kBindingSamples);
  return {.binding = abi::kBindingSamples, .kind = DescriptorKind::kTexels, .texels = &texels};
}

void StructureSlot::upload(const Frame& frame, const SourcePart& part) {
  staged_ = stagedLayers(frame, part);
  mean_color_->forget();
  source_camera_ = cameraOf(frame.format, part);
  std::byte* const upload = staging().mapped().data();
  for (uint32_t i = 0; i < staged_.size(); ++i) {
    const LayerPlanes& planes = frame.sources[part.source][i];
    std::byte* const color =
        color_is_in_place_ ? color_.mapped(i).data() : upload + staged_[i].color.offset;
    const size_t depth_bytes = staged_[i].depth.size_bytes;
    const uint32_t face = part.face.value_or(0);
    std::memcpy(upload + staged_[i].depth.offset, planes.depth->data() + face * depth_bytes,
                depth_bytes);
    if (staged_[i].surface.size_bytes > 0) {
      copySurface(*planes.surface, part, shape_.depth_px, upload + staged_[i].surface.offset);
    }
    if (part.face) {
      copyWithinApron(*planes.color, face, shape_.color_px[i], color);
    } else {
      std::memcpy(color, planes.color->data(), planes.color->size());
    }
  }
  describe(frame, part);
}

void StructureSlot::describe(const Frame& frame, const SourcePart& part) {
  const SourceFormat& source = frame.format.sources[part.source];
  const Intrinsics& intrinsics = source_camera_.intrinsics;
  depth_planes_ = {.samples = addressWords(staging().address()),
                   .focal_px = abi::vec2(intrinsics.focal_px),
                   .principal_px = abi::vec2(intrinsics.principal_px),
                   .planes = {}};
  conversions_.clear();
  for (size_t i = 0; i < staged_.size(); ++i) {
    const uint32_t layer = uint32_t(i);
    depth_planes_.planes[i] = describeDepth(source.layers[i].depth, staged_[i].depth.offset);
    abi::ConvertColorPush color =
        describeConversion(source.layers[i].color, frame.sources[part.source][i].color_encoding,
                           frame.format.exposure_ev, frame.format.tone_map);
    color.texel_count = uint32_t(shape_.color_px[i].area());
    color.from = addressWords(staging().address() + staged_[i].color.offset);
    color.to = addressWords(color_.address(layer));
    color.to_format = colorFormat(shape_.color_storage);
    conversions_.push_back(color);
    build_.inv_z[i] = addressWords(invZ().address(layer));
    build_.layers[i] = addressWords(structure_.address(layer));
  }
  std::memcpy(depth_planes_upload_.mapped().data(), &depth_planes_, sizeof depth_planes_);
  build_.measured = addressWords(measured_.address());
  build_.width_px = shape_.depth_px.width;
  build_.height_px = shape_.depth_px.height;
  build_.layer_count = shape_.layerCount();
  build_.apron_px = part.face ? abi::kCubeApron_px : 0;
  build_.given_kappa = float(source.connection_tolerance);
  build_.format_step = {};
  for (const LayerFormat& layer : source.layers) {
    build_.format_step = glm::max(build_.format_step, surfaceStep(layer.depth));
  }
}

abi::MeasuredHead StructureSlot::measuredHead() const {
  abi::MeasuredHead measured;
  std::memcpy(&measured, measured_readback_.mapped().data(), sizeof measured);
  return measured;
}

SourceStats StructureSlot::stats() const {
  const abi::MeasuredHead measured = measuredHead();
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

DepthSpread StructureSlot::depthSpread() const {
  std::array<uint32_t, abi::kDepthHistogramBinCount> counts;
  std::memcpy(counts.data(),
              measured_readback_.mapped().data() + offsetof(abi::Measured, depth_histogram),
              sizeof counts);
  return viewloom::depthSpread(
      counts, [](uint32_t bin) { return abi::binStart(bin, abi::kDepthMantissaBits); });
}

}  // namespace viewloom
