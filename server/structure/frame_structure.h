// SPDX-License-Identifier: Apache-2.0
// The structures of all sources of a frame, one slot each.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "structure/structure_builder.h"
#include "structure/structure_slot.h"

namespace viewloom {

// Owner decides when it is free, as of a slot. Thread-safety: as StructureSlot.
class FrameStructure {
 public:
  // Throws vk::OutOfDeviceMemoryError when the device cannot hold it.
  FrameStructure(const Device& device, const std::vector<FrameShape>& shapes);

  // Copies the planes into mapped memory. The frame's sources have these shapes.
  void upload(const Frame& frame);
  // From uploaded planes to structures that can be traced.
  void recordBuild(vk::CommandBuffer commands, const StructureBuilder& builder) const;

  std::span<const StructureSlot* const> sources() const { return sources_; }
  const StructureSlot& firstSource() const { return *sources_.front(); }

 private:
  std::vector<std::unique_ptr<StructureSlot>> slots_;
  std::vector<const StructureSlot*> sources_;  // the same
};

}  // namespace viewloom
