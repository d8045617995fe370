// SPDX-License-Identifier: Apache-2.0
#include "structure/structure_variants.h"

#include <algorithm>
#include <span>

#include "structure/array_options.h"
#include "structure/describe_planes.h"

namespace viewloom {
namespace {

PrepareVariant preparationOf(const StructureVariant& structure,
                             std::span<const abi::DepthPlane> planes) {
  const uint32_t first_type = planes.front().sample_type;
  const bool is_uniform = std::ranges::all_of(
      planes, [&](const abi::DepthPlane& plane) { return plane.sample_type == first_type; });
  return {.structure = structure,
          .sample_type = is_uniform ? first_type : abi::kDepthSampleMixed,
          .has_ray_distance = std::ranges::any_of(
              planes, [](const abi::DepthPlane& plane) { return plane.ray_distance != 0; })};
}

}  // namespace

StructureVariant variantOf(const StructureSlot& slot) {
  return {.reads_by_address = slot.readsByAddress(),
          .writes_by_address = slot.writesByAddress(),
          .layer_count = slot.shape().layerCount()};
}

PrepareVariant preparationOf(const StructureSlot& slot) {
  return preparationOf(variantOf(slot), {slot.depthPlanes().planes, slot.shape().layerCount()});
}

PrepareVariant preparationOf(const Device& device, const Frame& frame, const SourcePart& part) {
  const FrameShape shape = shapeOf(frame, part);
  const StructureVariant structure{
      .reads_by_address = mustDivide(device, shape),
      .writes_by_address = !LayeredBuffer::fitsStorage(device, invZOptions(device, shape)) ||
                           !LayeredBuffer::fitsStorage(device, structureOptions(device, shape)),
      .layer_count = shape.layerCount()};
  std::vector<abi::DepthPlane> planes;
  for (const LayerFormat& layer : frame.format.sources[part.source].layers) {
    planes.push_back(describeDepth(layer.depth, 0));
  }
  return preparationOf(structure, planes);
}

// Sensors send integers, everybody else floats; few send more than two layers.
std::vector<PrepareVariant> likelyPreparations() {
  std::vector<PrepareVariant> variants;
  for (uint32_t layer_count = 1; layer_count <= abi::kLayerCountMax; ++layer_count) {
    for (const uint32_t type : {abi::kDepthSampleF32, abi::kDepthSampleU16, abi::kDepthSampleF16}) {
      variants.push_back({.structure = {.layer_count = layer_count}, .sample_type = type});
    }
  }
  return variants;
}

}  // namespace viewloom
