// SPDX-License-Identifier: Apache-2.0
#include "structure/build_memory.h"

#include <algorithm>

#include "structure/array_options.h"

namespace viewloom {

BuildMemory::BuildMemory(const Device& device, const FrameShape& shape)
    : device_(device),
      shape_(shape),
      staging_(device,
               {.size_bytes = writesColorInPlace(device, shape) ? shape.staged_before_color_bytes
                                                                : shape.staged_bytes,
                .intent = MemoryIntent::kUpload,
                .debug_name = "staged planes"}),
      staging_texels_(mustDivide(device, shape)
                          ? TexelView()
                          : TexelView(device, staging_, TexelFormat::kR32Uint)),
      inv_z_(device, invZOptions(device, shape)) {}

const LayeredBuffer& BuildMemory::meansAlongY() {
  if (!means_along_y_) {
    means_along_y_ = std::make_unique<LayeredBuffer>(device_, meanColorOptions(device_, shape_));
  }
  return *means_along_y_;
}

FrameBuildMemory makeBuildMemory(const Device& device, const std::vector<FrameShape>& shapes) {
  FrameBuildMemory memory;
  memory.reserve(shapes.size());
  for (const FrameShape& shape : shapes) {
    memory.push_back(std::make_shared<BuildMemory>(device, shape));
  }
  return memory;
}

bool fits(const FrameBuildMemory& memory, const std::vector<FrameShape>& shapes) {
  return std::equal(
      memory.begin(), memory.end(), shapes.begin(), shapes.end(),
      [](const BuildMemoryPtr& part, const FrameShape& shape) { return part->shape() == shape; });
}

}  // namespace viewloom
