// SPDX-License-Identifier: Apache-2.0
#include "bench/gpu/dda_mirrors.h"

#include <algorithm>

#include "gpu/commands.h"
#include "shaders/dda_mirrors.h"
#include "shared/reflection_abi.h"
#include "trace/band_params.h"
#include "trace/mirrored_structure.h"

namespace viewloom::bench {
namespace {

struct MarchPush {
  abi::TracePush trace;
  abi::MarchKnobs knobs;
};
static_assert(sizeof(MarchPush) == 128);  // what any device takes

}  // namespace

DdaMirrors::DdaMirrors(const Device& device)
    : albedos_(device),
      march_(device,
             {.spirv = dda_mirrors_spirv,
              .push_bytes = sizeof(MarchPush),
              .descriptors = mirrorSlots({{abi::kBindingInvZ, DescriptorKind::kTexels},
                                          {abi::kBindingReflected, DescriptorKind::kStorage}}),
              .debug_name = "dda mirrors"}) {}

void DdaMirrors::record(Commands commands, const ReflectedRows& rows, const MarchOptions& options) {
  const StructureSlot& structure = rows.structure;
  std::vector<Descriptor> descriptors = mirrorDescriptors(structure, rows.params, albedos_);
  descriptors.push_back(wholeBuffer(abi::kBindingReflected, rows.reflected));
  descriptors.push_back(structure.invZ().asTexels(abi::kBindingInvZ));
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
