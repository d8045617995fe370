// SPDX-License-Identifier: Apache-2.0
// The structures of all sources of a frame, one slot each; of a cube map, one a face.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "gpu/commands.h"
#include "structure/structure_builder.h"
#include "structure/structure_slot.h"

namespace viewloom {

// Owner decides when it is free, as of a slot. Thread-safety: as StructureSlot.
class FrameStructure {
 public:
  // Structures of all parts of a frame. Throws (isOutOfDeviceMemory) when the device cannot hold
  // it.
  FrameStructure(const Device& device, const FrameBuildMemory& build_memory);
  // Shares no memory with others.
  FrameStructure(const Device& device, const std::vector<FrameShape>& shapes);

  // The next upload and build take place there. It has the same shapes.
  void buildIn(const FrameBuildMemory& build_memory);

  // Copies the planes into mapped memory. The frame's parts have these shapes.
  void upload(const Frame& frame);
  // From uploaded planes to structures that can be traced.
  void recordBuild(Commands commands, const StructureBuilder& builder) const;
  // The same, in several submissions if wanted.
  void recordBuild(CutRecording& cuts, const StructureBuilder& builder) const;

  // Slots of the parts of the frame.
  std::span<const StructureSlot* const> parts() const { return parts_; }
  const StructureSlot& firstPart() const { return *parts_.front(); }

  // Statistics of each source, valid after the build's submission is done. For a cube map, counts
  // are sums over the faces, ranges cover all faces, and the rest is that of the front face.
  std::vector<SourceStats> stats() const;
  // Depths of the first source, valid then; for a cube map, of its front face.
  DepthSpread depthSpread() const;

 private:
  // Parts of which a source is built.
  struct BuiltSource {
    std::span<const StructureSlot* const> parts;
    Buffer face_list;  // of a cube map: abi::CubeFaceList
  };

  // For the device, where the faces of cube maps lie.
  void describeCubes() const;

  std::vector<std::unique_ptr<StructureSlot>> slots_;
  std::vector<const StructureSlot*> parts_;  // the same
  std::vector<BuiltSource> sources_;
};

}  // namespace viewloom
