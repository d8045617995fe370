// SPDX-License-Identifier: Apache-2.0
#include "bench/gpu/inv_z_build.h"

#include <algorithm>

#include "gpu/commands.h"
#include "structure/structure_passes.h"

namespace viewloom::bench {
namespace {

// The variant that server/engine/walk/structure/structure_builder.cpp takes.
PrepareVariant variantOf(const StructureSlot& slot) {
  const std::span planes(slot.depthPlanes().planes, slot.shape().layerCount());
  const uint32_t first_type = planes.front().sample_type;
  const bool is_uniform = std::all_of(planes.begin(), planes.end(), [&](const auto& plane) {
    return plane.sample_type == first_type;
  });
  return {.structure = {.reads_by_address = slot.readsByAddress(),
                        .writes_by_address = slot.writesByAddress(),
                        .layer_count = slot.shape().layerCount()},
          .sample_type = is_uniform ? first_type : abi::kDepthSampleMixed,
          .has_ray_distance = std::any_of(planes.begin(), planes.end(), [](const auto& plane) {
            return plane.ray_distance != 0;
          })};
}

// The upload is part of making the slot, so that what follows knows the frame's format.
StructureSlot uploaded(const Device& device, const Frame& frame) {
  StructureSlot slot(device, shapeOf(frame));
  slot.upload(frame);
  return slot;
}

}  // namespace

InvZBuild::InvZBuild(const Device& device, const BenchLoad& load)
    : slot_(uploaded(device, *load.frame)),
      prepare_columns_(makePrepareColumns(device, variantOf(slot_))) {}

void InvZBuild::record(Commands commands) const {
  // Counters of bad samples: nobody reads them here.
  commands.fill(slot_.measured(), 0);
  for (uint32_t i = 0; !slot_.colorIsInPlace() && i < slot_.shape().layerCount(); ++i) {
    commands.copy(slot_.staging(), slot_.color().buffer(i),
                  {.from_offset = slot_.staged()[i].color.offset,
                   .to_offset = slot_.color().offsetBytes(i),
                   .size_bytes = slot_.staged()[i].color.size_bytes});
  }
  recordTransferToCompute(commands);
  const SizePx size_px = slot_.shape().depth_px;
  const uint32_t blocks_x = abi::invZPitch(size_px.width) / abi::kBlockPx;
  const uint32_t blocks_y = (size_px.height + abi::kBlockPx - 1) / abi::kBlockPx + 2;
  prepare_columns_.recordDescriptors(
      commands,
      std::vector<Descriptor>{slot_.measuredDescriptor(), slot_.invZ().asTexels(abi::kBindingInvZ),
                              slot_.invZ().asStorage(abi::kBindingInvZOut),
                              slot_.depthPlanesDescriptor(), slot_.stagingDescriptor()});
  prepare_columns_.record(commands, slot_.buildPush(),
                          (blocks_x + abi::kNodeGroupSize - 1) / abi::kNodeGroupSize, blocks_y, 1);
  recordComputeBarrier(commands);
}

}  // namespace viewloom::bench
