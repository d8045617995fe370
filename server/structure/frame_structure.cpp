// SPDX-License-Identifier: Apache-2.0
#include "structure/frame_structure.h"

namespace viewloom {

FrameStructure::FrameStructure(const Device& device, const std::vector<FrameShape>& shapes) {
  for (const FrameShape& shape : shapes) {
    slots_.push_back(std::make_unique<StructureSlot>(device, shape));
    sources_.push_back(slots_.back().get());
  }
}

void FrameStructure::upload(const Frame& frame) {
  for (size_t source = 0; source < slots_.size(); ++source) slots_[source]->upload(frame, source);
}

void FrameStructure::recordBuild(vk::CommandBuffer commands,
                                 const StructureBuilder& builder) const {
  for (const StructureSlot* source : sources_) builder.record(commands, *source, nullptr);
}

}  // namespace viewloom
