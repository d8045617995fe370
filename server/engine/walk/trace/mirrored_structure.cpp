// SPDX-License-Identifier: Apache-2.0
#include "trace/mirrored_structure.h"

#include "shared/lens_abi.h"
#include "shared/reflection_abi.h"
#include "shared/trace_abi.h"
#include "trace/reflection_settings.h"

namespace viewloom {

std::vector<DescriptorSlot> mirrorSlots(std::initializer_list<DescriptorSlot> own_slots) {
  std::vector<DescriptorSlot> slots = {{abi::kBindingStructure, DescriptorKind::kTexels},
                                       {abi::kBindingStructureHalves, DescriptorKind::kTexels},
                                       {abi::kBindingColor, DescriptorKind::kTexels},
                                       {abi::kBindingSurface, DescriptorKind::kTexels},
                                       {abi::kBindingMeasured, DescriptorKind::kUniform},
                                       {abi::kBindingViews, DescriptorKind::kStorage},
                                       {abi::kBindingExtras, DescriptorKind::kUniform},
                                       {abi::kBindingReflection, DescriptorKind::kUniform},
                                       {abi::kBindingAlbedos, DescriptorKind::kStorage},
                                       {abi::kBindingLensPoints, DescriptorKind::kStorage}};
  slots.insert(slots.end(), own_slots);
  return slots;
}

std::vector<Descriptor> mirrorDescriptors(const StructureSlot& structure,
                                          std::span<const Descriptor> params, Albedos& albedos) {
  std::vector<Descriptor> descriptors(params.begin(), params.end());
  for (const Descriptor& descriptor :
       {structure.measuredDescriptor(), albedos.descriptor(),
        structure.structure().asTexels(abi::kBindingStructure),
        structure.structure().asHalfTexels(abi::kBindingStructureHalves),
        structure.color().asTexels(abi::kBindingColor)}) {
    descriptors.push_back(descriptor);
  }
  if (structure.surface() != nullptr) {
    descriptors.push_back(structure.surface()->asTexels(abi::kBindingSurface));
  }
  return descriptors;
}

std::vector<Descriptor> mirrorParams(const Walk& walk, uint32_t first_walk, const TraceSlot& slot) {
  std::vector<Descriptor> params = slot.params().of(walk.job, walk.index, walk.rays.sample);
  params.push_back(slot.writeReflectionSettings(
      walk.index, reflectionSettings(walk.structure, walk.job, walk.index, first_walk)));
  params.push_back(slot.params().lensPoints(walk.job, walk.rays.sample));
  return params;
}

}  // namespace viewloom
