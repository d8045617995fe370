// SPDX-License-Identifier: Apache-2.0
#include "structure/structure_slot.h"

#include <bit>
#include <cmath>
#include <cstring>

#include "base/check.h"
#include "structure/describe_planes.h"

namespace viewloom {
namespace {

StructureSlot::LayerBuffers makeLayer(const Device& device, const StructureLayout& layout) {
  const auto make = [&](uint64_t size_bytes, const char* name) {
    return Buffer(device, {.size_bytes = size_bytes, .debug_name = name});
  };
  return {.inv_z = make(layout.invZBytes(), "inv_z"),
          .facets = make(layout.facetBytes(), "facets"),
          .links = make(layout.linkBytes(), "links"),
          .entries = make(layout.entryBytes(), "entries"),
          .nodes = make(layout.nodeBytes(), "nodes")};
}

}  // namespace

StructureSlot::StructureSlot(const Device& device, const FrameShape& shape)
    : shape_(shape),
      layout_(structureLayout(shape.depth_px)),
      staging_(device, {.size_bytes = shape.staged_bytes,
                        .intent = MemoryIntent::kUpload,
                        .debug_name = "staged planes"}),
      structure_upload_(device, {.size_bytes = sizeof(abi::Structure),
                                 .intent = MemoryIntent::kUpload,
                                 .debug_name = "structure upload"}),
      structure_(device, {.size_bytes = sizeof(abi::Structure), .debug_name = "structure"}),
      measured_(device, {.size_bytes = sizeof(abi::Measured), .debug_name = "measured"}),
      measured_readback_(device, {.size_bytes = offsetof(abi::Measured, depth_histogram),
                                  .intent = MemoryIntent::kReadback,
                                  .debug_name = "measured readback"}) {
  for (const SizePx& color_px : shape.color_px) {
    color_.emplace_back(device, BufferOptions{.size_bytes = colorBytes(shape.color_storage, color_px),
                                              .debug_name = "color"});
    layers_.push_back(makeLayer(device, layout_));
  }
  staged_.reserve(shape.layerCount());
  conversions_.reserve(shape.layerCount());
}

void StructureSlot::upload(const Frame& frame) {
  staged_ = stagedLayers(frame);
  source_camera_ = frame.format.sources.front().camera;
  std::byte* const to = staging_.mapped().data();
  for (size_t i = 0; i < staged_.size(); ++i) {
    const LayerPlanes& planes = frame.sources.front()[i];
    std::memcpy(to + staged_[i].depth.offset, planes.depth->data(), planes.depth->size());
    std::memcpy(to + staged_[i].color.offset, planes.color->data(), planes.color->size());
  }
  conversions_.clear();
  for (size_t i = 0; i < staged_.size(); ++i) {
    abi::ConvertColorPush push =
        describeConversion(frame.format.sources.front().layers[i].color,
                           frame.sources.front()[i].color_encoding, frame.format.exposure_ev);
    push.from = addressWords(staging_.address() + staged_[i].color.offset);
    push.to = addressWords(color_[i].address());
    conversions_.push_back(push);
  }
  const abi::Structure described = describe(frame);
  std::memcpy(structure_upload_.mapped().data(), &described, sizeof described);
}

abi::Structure StructureSlot::describe(const Frame& frame) const {
  const SourceFormat& source = frame.format.sources.front();
  abi::Structure described{};
  described.width_px = shape_.depth_px.width;
  described.height_px = shape_.depth_px.height;
  described.layer_count = shape_.layerCount();
  described.color_format =
      shape_.color_storage == ColorStorage::kRgba8Srgb ? abi::kColorRgba8 : abi::kColorRgba16f;
  described.focal_x_px = float(source.camera.intrinsics.focal_px.x);
  described.focal_y_px = float(source.camera.intrinsics.focal_px.y);
  described.principal_x_px = float(source.camera.intrinsics.principal_px.x);
  described.principal_y_px = float(source.camera.intrinsics.principal_px.y);
  described.given_kappa = float(source.connection_tolerance);
  described.measured = addressWords(measured_.address());
  for (uint32_t i = 0; i < abi::kLevelCount; ++i) {
    described.level_offset[i] = layout_.levels[i].offset;
    described.level_width[i] = layout_.levels[i].size.width;
    described.level_height[i] = layout_.levels[i].size.height;
  }
  for (uint32_t i = 0; i < shape_.layerCount(); ++i) {
    described.inv_z[i] = addressWords(layers_[i].inv_z.address());
    described.facets[i] = addressWords(layers_[i].facets.address());
    described.links[i] = addressWords(layers_[i].links.address());
    described.entries[i] = addressWords(layers_[i].entries.address());
    described.nodes[i] = addressWords(layers_[i].nodes.address());
    described.color[i] = {.texels = addressWords(color_[i].address()),
                          .width_px = shape_.color_px[i].width,
                          .height_px = shape_.color_px[i].height};
    described.depth[i] = describeDepth(source.layers[i].depth);
    described.depth[i].samples = addressWords(staging_.address() + staged_[i].depth.offset);
  }
  return described;
}

SourceStats StructureSlot::stats() const {
  abi::Measured measured;
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
          .inv_z_far = measured.inv_z_far};
}

}  // namespace viewloom
