// SPDX-License-Identifier: Apache-2.0
#include "bench/gpu/dda_mirrors.h"

#include <algorithm>

#include "gpu/barrier.h"
#include "shaders/dda_mirrors.h"
#include "shared/lens_abi.h"
#include "shared/reflection_abi.h"
#include "trace/band_params.h"

namespace viewloom::bench {
namespace {

constexpr DescriptorSlot kSlots[] = {{abi::kBindingStructure, DescriptorKind::kTexels},
                                     {abi::kBindingStructureHalves, DescriptorKind::kTexels},
                                     {abi::kBindingColor, DescriptorKind::kTexels},
                                     {abi::kBindingInvZ, DescriptorKind::kTexels},
                                     {abi::kBindingSurface, DescriptorKind::kTexels},
                                     {abi::kBindingMeasured, DescriptorKind::kUniform},
                                     {abi::kBindingViews, DescriptorKind::kStorage},
                                     {abi::kBindingExtras, DescriptorKind::kUniform},
                                     {abi::kBindingReflection, DescriptorKind::kUniform},
                                     {abi::kBindingAlbedos, DescriptorKind::kStorage},
                                     {abi::kBindingLensPoints, DescriptorKind::kStorage},
                                     {abi::kBindingReflected, DescriptorKind::kStorage}};

struct MarchPush {
  abi::TracePush trace;
  abi::MarchKnobs knobs;
};
static_assert(sizeof(MarchPush) == 128);  // what any device takes

}  // namespace

DdaMirrors::DdaMirrors(const Device& device)
    : albedos_(device),
      march_(device, {.spirv = dda_mirrors_spirv,
                      .push_bytes = sizeof(MarchPush),
                      .descriptors = kSlots,
                      .debug_name = "dda mirrors"}) {}

void DdaMirrors::record(Commands commands, const ReflectedRows& rows, const MarchOptions& options) {
  const StructureSlot& structure = rows.structure;
  std::vector<Descriptor> descriptors(rows.params.begin(), rows.params.end());
  for (const Descriptor& descriptor :
       {structure.measuredDescriptor(), albedos_.descriptor(),
        wholeBuffer(abi::kBindingReflected, rows.reflected),
        structure.structure().asTexels(abi::kBindingStructure),
        structure.structure().asHalfTexels(abi::kBindingStructureHalves),
        structure.color().asTexels(abi::kBindingColor),
        structure.invZ().asTexels(abi::kBindingInvZ),
        structure.surface()->asTexels(abi::kBindingSurface)}) {
    descriptors.push_back(descriptor);
  }
  const uint32_t layer_count = std::min(options.layer_count, structure.shape().layerCount());
  const MarchPush push{
      .trace = rows.push,
      .knobs = {.layer_stride = options.stride_px | layer_count << abi::kMarchLayerShift,
                .step_count_max = options.step_count_max,
                .thickness_m = float(options.thickness_m)}};
  recordComputeBarrier(commands);
  march_.recordDescriptors(commands, descriptors);
  march_.record(commands, push, groupCount(rows.push.atlas_width_px), rows.row_count);
  recordComputeBarrier(commands);
}

}  // namespace viewloom::bench
