// SPDX-License-Identifier: Apache-2.0
#include "pipeline/frame_builder.h"

#include <utility>

#include "gpu/device_error.h"
#include "lens/host_structure.h"

namespace viewloom {

std::shared_ptr<StructureBuild> FrameBuilder::takeSlot(SlotPool<StructureBuild>& slots,
                                                       FrameBuildMemory& memory, const Frame& frame,
                                                       std::atomic<bool>& is_walked) const {
  const std::vector<FrameShape> shapes = shapesOf(frame);
  std::shared_ptr<StructureBuild> slot =
      slots.take([&](const StructureBuild& free) { return free.shapes == shapes; },
                 [&] { return std::make_unique<StructureBuild>(shapes); });
  if (!slot) return nullptr;
  // A GPU walks everything: there the walk is faster than the CPU beside it.
  slot->is_swept = links_.device.info().is_software && canSweep(frame);
  slot->is_walked = is_walked.exchange(false) || !slot->is_swept;
  try {
    if (slot->is_walked) {
      if (!fits(memory, shapes)) memory = makeBuildMemory(links_.device, shapes);
      slot->prepareWalked(links_.device, memory);
    }
  } catch (const std::exception& error) {
    if (!isOutOfDeviceMemory(error) || !slot->is_swept) throw;
    slot->is_walked = false;  // those who need it are told, the others are served
  }
  return slot;
}

void FrameBuilder::build(const FramePtr& frame, std::shared_ptr<StructureBuild> slot,
                         ResidentStructure& structure) {
  const int64_t started_ns = links_.clock.nowNs();
  if (slot->is_walked) slot->walked->structure.upload(*frame);
  const int64_t uploaded_ns = links_.clock.nowNs();
  if (slot->is_swept) slot->swept.prepare(frame, workers_);
  if (slot->is_walked) gpu_.build(*slot);
  structure.built_at_ns = links_.clock.nowNs();
  structure.upload_ns = uploaded_ns - started_ns;
  structure.build_ns = structure.built_at_ns - uploaded_ns;

  structure.stats =
      slot->is_swept ? slot->swept.measured().stats : slot->walked->structure.stats().front();
  structure.depths =
      slot->is_swept ? slot->swept.measured().depths : slot->walked->structure.depthSpread();
  for (const LayerPlanes& layer : frame->sources.front()) {
    structure.stats.bad_normals_count += layer.bad_normals_count;
    structure.stats.bad_motions_count += layer.bad_motions_count;
  }
  structure.is_in_reach = isInReach(links_.device, slot->shapes.front());
  structure.build = std::move(slot);
}

}  // namespace viewloom
