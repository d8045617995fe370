// SPDX-License-Identifier: Apache-2.0
// Planes that a build reads, its columns, and the memory in which means of colour are made. Nobody
// reads it afterwards, so structures that are built one after the other share it.
#pragma once

#include <memory>
#include <vector>

#include "structure/frame_shape.h"
#include "structure/layered_buffer.h"

namespace viewloom {

// Build memory for one part of a frame. The device must outlive it. Thread-safety: none. Its users
// make sure that the device is done with one build before they write the planes of the next.
class BuildMemory {
 public:
  // Throws when the device cannot hold it (isOutOfDeviceMemory).
  BuildMemory(const Device& device, const FrameShape& shape);

  const FrameShape& shape() const { return shape_; }
  // The upload, and where it can be read as words: undivided.
  const Buffer& staging() const { return staging_; }
  const TexelView& stagingTexels() const { return staging_texels_; }
  const LayeredBuffer& invZ() const { return inv_z_; }  // float, abi::invZIndex
  // Intermediate means along the rows, allocated at the first call. A writer waits for earlier
  // submissions.
  const LayeredBuffer& meansAlongY();

 private:
  const Device& device_;
  FrameShape shape_;
  Buffer staging_;
  TexelView staging_texels_;
  LayeredBuffer inv_z_;
  std::unique_ptr<LayeredBuffer> means_along_y_;
};

using BuildMemoryPtr = std::shared_ptr<BuildMemory>;

// Memory of all parts of a frame, in their order.
using FrameBuildMemory = std::vector<BuildMemoryPtr>;

FrameBuildMemory makeBuildMemory(const Device& device, const std::vector<FrameShape>& shapes);
bool fits(const FrameBuildMemory& memory, const std::vector<FrameShape>& shapes);

}  // namespace viewloom
