// SPDX-License-Identifier: Apache-2.0
// The GPU resources of one structure, reused from frame to frame.
#pragma once

#include <vector>

#include "frame/frame.h"
#include "frame/stage_times.h"
#include "gpu/buffer.h"
#include "shared/structure_abi.h"
#include "structure/frame_shape.h"
#include "structure/structure_layout.h"

namespace viewloom {

// Owner decides when the slot is free: not before the timeline value of its last use is reached.
// Thread-safety: none by itself; upload() may run on any thread while the slot is free.
class StructureSlot {
 public:
  // Throws vk::OutOfDeviceMemoryError when the device cannot hold it.
  StructureSlot(const Device& device, const FrameShape& shape);

  // Copies the planes and describes them in mapped memory. The frame has this slot's shape.
  void upload(const Frame& frame);

  const FrameShape& shape() const { return shape_; }
  const StructureLayout& layout() const { return layout_; }
  // Of the uploaded frame.
  const Camera& sourceCamera() const { return source_camera_; }
  // abi::Structure, for shaders.
  vk::DeviceAddress address() const { return structure_.address(); }
  // Once the build's submission is done.
  SourceStats stats() const;

  // What the build's passes need beside abi::Structure.
  const Buffer& staging() const { return staging_; }
  const std::vector<StagedLayer>& staged() const { return staged_; }
  const std::vector<Buffer>& color() const { return color_; }
  const Buffer& structureUpload() const { return structure_upload_; }
  const Buffer& structure() const { return structure_; }
  const Buffer& measured() const { return measured_; }
  const Buffer& measuredReadback() const { return measured_readback_; }
  // One per layer: what a colour plane that must be converted is.
  const std::vector<abi::ConvertColorPush>& conversions() const { return conversions_; }

  // Arrays of one layer, for tests that read them back.
  struct LayerBuffers {
    Buffer inv_z;
    Buffer facets;
    Buffer links;
    Buffer entries;
    Buffer nodes;
  };
  const std::vector<LayerBuffers>& layers() const { return layers_; }

 private:
  abi::Structure describe(const Frame& frame) const;

  FrameShape shape_;
  StructureLayout layout_;
  Camera source_camera_;
  Buffer staging_;
  Buffer structure_upload_;
  Buffer structure_;
  Buffer measured_;
  Buffer measured_readback_;
  std::vector<Buffer> color_;
  std::vector<LayerBuffers> layers_;
  std::vector<StagedLayer> staged_;
  std::vector<abi::ConvertColorPush> conversions_;
};

// A device address as shaders take it.
inline abi::uvec2 addressWords(vk::DeviceAddress address) {
  return {uint32_t(address), uint32_t(address >> 32)};
}

}  // namespace viewloom
