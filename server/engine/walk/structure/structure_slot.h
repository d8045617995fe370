// SPDX-License-Identifier: Apache-2.0
// The GPU resources of one part's structure, reused from frame to frame.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "frame/depth_spread.h"
#include "frame/frame.h"
#include "frame/stage_times.h"
#include "shared/structure_abi.h"
#include "structure/build_memory.h"
#include "structure/frame_shape.h"
#include "structure/mean_color.h"
#include "structure/structure_layout.h"

namespace viewloom {

// Owner decides when the slot is free: not before the timeline value of its last use is reached.
// Thread-safety: none by itself; upload() may run on any thread while the slot is free.
class StructureSlot {
 public:
  // Throws when the device cannot hold it (isOutOfDeviceMemory).
  StructureSlot(const Device& device, BuildMemoryPtr build_memory);
  // Shares no memory with others.
  StructureSlot(const Device& device, const FrameShape& shape);

  // The next upload and build take place there. It has this slot's shape.
  void buildIn(BuildMemoryPtr build_memory);

  // Copies the planes of a part into mapped memory. It has this slot's shape.
  void upload(const Frame& frame, const SourcePart& part = {});

  const FrameShape& shape() const { return shape_; }
  const StructureLayout& layout() const { return layout_; }
  // Camera of the uploaded part.
  const Camera& sourceCamera() const { return source_camera_; }
  // Once the build's submission is done.
  abi::MeasuredHead measuredHead() const;
  SourceStats stats() const;
  // Depths of its first layer, in percentiles like those of stats.
  DepthSpread depthSpread() const;

  // Kernels reach what is read as texels, or what is written, by address: it is larger than
  // bindings.
  bool readsByAddress() const { return structure_.isDivided(); }
  bool writesByAddress() const { return writes_by_address_; }

  // Colour needs no pass: it was uploaded to where it is read.
  bool colorIsInPlace() const { return color_is_in_place_; }

  const Buffer& staging() const { return build_memory_->staging(); }
  const std::vector<StagedLayer>& staged() const { return staged_; }
  const LayeredBuffer& color() const { return color_; }  // texels
  uint32_t colorStride() const;                          // texels from layer to layer
  // abi::SurfaceTexel per px, of a source that mirrors; else nullptr.
  const LayeredBuffer* surface() const { return surface_.get(); }
  MeanColor& meanColor() const { return *mean_color_; }  // of the uploaded source
  const LayeredBuffer& meansAlongY() const { return build_memory_->meansAlongY(); }
  const LayeredBuffer& invZ() const { return build_memory_->invZ(); }
  const LayeredBuffer& structure() const { return structure_; }  // cells, then links
  const Buffer& measured() const { return measured_; }
  const Buffer& measuredReadback() const { return measured_readback_; }
  Descriptor measuredDescriptor() const;
  Descriptor depthPlanesDescriptor() const;
  // The upload as words; as good as none where kernels read by address.
  Descriptor stagingDescriptor() const;

  // Parameters of the build's passes for the uploaded frame.
  const abi::DepthPlanes& depthPlanes() const { return depth_planes_; }
  const std::vector<abi::ConvertColorPush>& conversions() const { return conversions_; }
  const abi::BuildPush& buildPush() const { return build_; }

 private:
  void describe(const Frame& frame, const SourcePart& part);

  FrameShape shape_;
  BuildMemoryPtr build_memory_;
  StructureLayout layout_;
  Camera source_camera_;
  bool color_is_in_place_;
  Buffer depth_planes_upload_;
  Buffer measured_;
  Buffer measured_readback_;
  LayeredBuffer color_;
  std::unique_ptr<MeanColor> mean_color_;
  std::unique_ptr<LayeredBuffer> surface_;
  LayeredBuffer structure_;
  bool writes_by_address_;
  std::vector<StagedLayer> staged_;
  abi::DepthPlanes depth_planes_{};
  std::vector<abi::ConvertColorPush> conversions_;
  abi::BuildPush build_{};
};

// A device address as shaders take it.
inline abi::Address addressWords(uint64_t address) {
  return {uint32_t(address), uint32_t(address >> 32)};
}

}  // namespace viewloom
