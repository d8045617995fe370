// SPDX-License-Identifier: Apache-2.0
#include "structure/frame_structure.h"

#include <algorithm>
#include <cstring>

#include <glm/common.hpp>

#include "base/check.h"
#include "frame/cube_map.h"
#include "shared/cube_abi.h"

namespace viewloom {
namespace {

static_assert(abi::kCubeFaces == kCubeFaceCount);

abi::CubeFace describeFace(uint32_t face, const StructureSlot& slot) {
  const glm::dquat orientation = cubeFaceOrientation(face);
  // Whole numbers, but for the rounding of the quaternion.
  const auto direction = [&](const glm::dvec3& in_face) {
    return abi::vec3(glm::round(orientation * in_face));
  };
  abi::CubeFace described{.right = direction({1, 0, 0}),
                          .down = direction({0, -1, 0}),
                          .forward = direction({0, 0, -1}),
                          .inv_z = {},
                          .layers = {},
                          .color = {},
                          .measured = addressWords(slot.measured().address())};
  for (uint32_t layer = 0; layer < slot.shape().layerCount(); ++layer) {
    described.inv_z[layer] = addressWords(slot.invZ().address(layer));
    described.layers[layer] = addressWords(slot.structure().address(layer));
    described.color[layer] = addressWords(slot.color().address(layer));
  }
  return described;
}

void describeFaces(std::span<const StructureSlot* const> faces, const Buffer& face_list) {
  const FrameShape& shape = faces.front()->shape();
  abi::CubeFaceList list{.faces = {},
                         .side_px = shape.depth_px.width - 2 * abi::kCubeApron_px,
                         .layer_count = shape.layerCount()};
  for (uint32_t face = 0; face < kCubeFaceCount; ++face) {
    list.faces[face] = describeFace(face, *faces[face]);
  }
  std::memcpy(face_list.mapped().data(), &list, sizeof list);
}

SourceStats statsOfCube(std::span<const StructureSlot* const> faces) {
  SourceStats stats = faces[kCubeFrontFace]->stats();
  for (uint32_t face = 0; face < kCubeFrontFace; ++face) {
    const SourceStats other = faces[face]->stats();
    stats.bad_samples_count += other.bad_samples_count;
    stats.unsorted_columns_count += other.unsorted_columns_count;
    stats.inv_z_min = std::min(stats.inv_z_min, other.inv_z_min);
    stats.inv_z_max = std::max(stats.inv_z_max, other.inv_z_max);
  }
  return stats;
}

}  // namespace

FrameStructure::FrameStructure(const Device& device, const FrameBuildMemory& build_memory) {
  for (const BuildMemoryPtr& part : build_memory) {
    slots_.push_back(std::make_unique<StructureSlot>(device, part));
    parts_.push_back(slots_.back().get());
  }
  for (size_t first = 0; first < parts_.size();) {
    const bool is_cube_map = parts_[first]->shape().is_cube_face;
    const size_t count = is_cube_map ? kCubeFaceCount : 1;
    VIEWLOOM_CHECK(first + count <= parts_.size());
    BuiltSource& source = sources_.emplace_back();
    source.parts = std::span(parts_).subspan(first, count);
    if (is_cube_map) {
      source.face_list = Buffer(device, {.size_bytes = sizeof(abi::CubeFaceList),
                                         .intent = MemoryIntent::kUpload,
                                         .debug_name = "faces of a cube map"});
    }
    first += count;
  }
  describeCubes();
}

FrameStructure::FrameStructure(const Device& device, const std::vector<FrameShape>& shapes)
    : FrameStructure(device, makeBuildMemory(device, shapes)) {}

void FrameStructure::buildIn(const FrameBuildMemory& build_memory) {
  VIEWLOOM_CHECK(build_memory.size() == slots_.size());
  for (size_t i = 0; i < slots_.size(); ++i) slots_[i]->buildIn(build_memory[i]);
  describeCubes();
}

void FrameStructure::describeCubes() const {
  for (const BuiltSource& source : sources_) {
    if (source.parts.size() > 1) describeFaces(source.parts, source.face_list);
  }
}

void FrameStructure::upload(const Frame& frame) {
  const std::vector<SourcePart> parts = partsOf(frame.format);
  VIEWLOOM_CHECK(parts.size() == slots_.size());
  for (size_t i = 0; i < parts.size(); ++i) slots_[i]->upload(frame, parts[i]);
}

void FrameStructure::recordBuild(Commands commands, const StructureBuilder& builder) const {
  CutRecording uncut(commands);
  recordBuild(uncut, builder);
}

void FrameStructure::recordBuild(CutRecording& cuts, const StructureBuilder& builder) const {
  for (const BuiltSource& source : sources_) {
    if (source.parts.size() == 1) {
      builder.record(cuts, *source.parts.front());
    } else {
      builder.recordCube(cuts, source.parts, source.face_list);
    }
  }
}

std::vector<SourceStats> FrameStructure::stats() const {
  std::vector<SourceStats> stats;
  for (const BuiltSource& source : sources_) {
    stats.push_back(source.parts.size() == 1 ? source.parts.front()->stats()
                                             : statsOfCube(source.parts));
  }
  return stats;
}

DepthSpread FrameStructure::depthSpread() const {
  const std::span<const StructureSlot* const> parts = sources_.front().parts;
  return parts[parts.size() == 1 ? 0 : kCubeFrontFace]->depthSpread();
}

}  // namespace viewloom
