// SPDX-License-Identifier: Apache-2.0
#include "structure/structure_builder.h"

#include <algorithm>
#include <span>

#include "gpu/commands.h"
#include "shared/cube_abi.h"

namespace viewloom {
namespace {

uint32_t groups(uint32_t count, uint32_t group_size) {
  return (count + group_size - 1) / group_size;
}

// Runs one stage between its time stamps.
class Timed {
 public:
  Timed(Commands commands, GpuTimer* timer, const char* name) : commands_(commands), timer_(timer) {
    if (timer_) timer_->recordBegin(commands_, name);
  }
  ~Timed() {
    if (timer_) timer_->recordEnd(commands_);
  }
  Timed(const Timed&) = delete;
  Timed& operator=(const Timed&) = delete;

 private:
  Commands commands_;
  GpuTimer* timer_;
};

template <typename Record>
void recordStage(Commands commands, GpuTimer* timer, const char* name, Record&& record) {
  const Timed timed(commands, timer, name);
  record();
}

// All counters 0, and a minimum that anything is below.
void recordClear(Commands commands, const Buffer& measured) {
  constexpr uint64_t kMin = offsetof(abi::MeasuredHead, inv_z_min_bits);
  commands.fill(measured, 0, kMin, 0);
  commands.fill(measured, kMin, sizeof(uint32_t), UINT32_MAX);
  commands.fill(measured, kMin + sizeof(uint32_t), kToTheEnd, 0);
}

std::vector<Descriptor> describeBindings(const StructureSlot& slot) {
  return {slot.measuredDescriptor(),
          slot.structure().asTexels(abi::kBindingStructure),
          slot.structure().asHalfTexels(abi::kBindingStructureHalves),
          slot.invZ().asTexels(abi::kBindingInvZ),
          slot.invZ().asStorage(abi::kBindingInvZOut),
          slot.structure().asStorage(abi::kBindingStructureOut),
          slot.depthPlanesDescriptor(),
          slot.stagingDescriptor()};
}

// How layers mirror; those that do not, mirror nothing.
void recordSurface(Commands commands, const StructureSlot& slot) {
  const LayeredBuffer* const surface = slot.surface();
  if (surface == nullptr) return;
  for (uint32_t i = 0; i < slot.shape().layerCount(); ++i) {
    const StagedPlane& staged = slot.staged()[i].surface;
    if (staged.size_bytes == 0) {
      commands.fill(surface->buffer(i), surface->offsetBytes(i), surface->layerBytes(), 0);
    } else {
      commands.copy(slot.staging(), surface->buffer(i),
                    {.from_offset = staged.offset,
                     .to_offset = surface->offsetBytes(i),
                     .size_bytes = staged.size_bytes});
    }
  }
}

StructureVariant variantOf(const StructureSlot& slot) {
  return {.reads_by_address = slot.readsByAddress(),
          .writes_by_address = slot.writesByAddress(),
          .layer_count = slot.shape().layerCount()};
}

PrepareVariant preparationOf(const StructureSlot& slot) {
  const std::span planes(slot.depthPlanes().planes, slot.shape().layerCount());
  const uint32_t first_type = planes.front().sample_type;
  const bool is_uniform = std::all_of(planes.begin(), planes.end(), [&](const auto& plane) {
    return plane.sample_type == first_type;
  });
  return {.structure = variantOf(slot),
          .sample_type = is_uniform ? first_type : abi::kDepthSampleMixed,
          .has_ray_distance = std::any_of(planes.begin(), planes.end(), [](const auto& plane) {
            return plane.ray_distance != 0;
          })};
}

// One build, stage after stage.
class Recording {
 public:
  Recording(Commands commands, const StructureSlot& slot, const StructurePasses& passes,
            const ComputePass& preparation)
      : commands_(commands),
        slot_(slot),
        passes_(passes),
        preparation_(preparation),
        bindings_(describeBindings(slot)) {}

  void prepare();
  void measure();
  void smooth();
  void buildFacets() { overNodes(passes_.build_facets, abi::kLevelFirst, 1); }
  void buildBlocks() { overNodes(passes_.build_blocks, abi::kLevelFirst, 1); }
  void buildLevels();

 private:
  // Dispatches, with what the slot binds, and lets later passes see the result.
  void dispatch(const ComputePass& pass, const abi::BuildPush& push, uint32_t groups_x,
                uint32_t groups_y, uint32_t groups_z);
  // An invocation a node; kernels that take whole columns dispatch one layer.
  void overNodes(const ComputePass& pass, uint32_t level, uint32_t layer_count);

  Commands commands_;
  const StructureSlot& slot_;
  const StructurePasses& passes_;
  const ComputePass& preparation_;
  std::vector<Descriptor> bindings_;
};

void Recording::dispatch(const ComputePass& pass, const abi::BuildPush& push, uint32_t groups_x,
                         uint32_t groups_y, uint32_t groups_z) {
  pass.recordDescriptors(commands_, bindings_);
  pass.record(commands_, push, groups_x, groups_y, groups_z);
  recordComputeBarrier(commands_);
}

void Recording::overNodes(const ComputePass& pass, uint32_t level, uint32_t layer_count) {
  const SizePx size = slot_.shape().depth_px;
  const uint32_t node_px = 1u << level;
  abi::BuildPush push = slot_.buildPush();
  push.level = level;
  dispatch(pass, push, groups(groups(size.width, node_px), abi::kNodeGroupSize),
           groups(size.height, node_px), layer_count);
}

// Also the guard around the image.
void Recording::prepare() {
  const SizePx size = slot_.shape().depth_px;
  const uint32_t blocks_x = abi::invZPitch(size.width) / abi::kBlockPx;
  dispatch(preparation_, slot_.buildPush(), groups(blocks_x, abi::kNodeGroupSize),
           groups(size.height, abi::kBlockPx) + 2, 1);
}

void Recording::measure() {
  const SizePx size = slot_.shape().depth_px;
  constexpr uint32_t kStripPx = abi::kMeasuredBlocks * abi::kBlockPx;
  const auto overStrips = [&](const ComputePass& pass) {
    dispatch(pass, slot_.buildPush(), groups(groups(size.width, kStripPx), abi::kNodeGroupSize),
             groups(size.height, abi::kBlockPx), 1);
  };
  overStrips(passes_.measure_depth);
  dispatch(passes_.settle_range, slot_.buildPush(), 1, 1, 1);
  overStrips(passes_.measure_range);
  dispatch(passes_.settle_tolerance, slot_.buildPush(), 1, 1, 1);
}

// The device has settled whether there is anything to do, and for which passes.
void Recording::smooth() {
  abi::BuildPush push = slot_.buildPush();
  for (uint32_t pass = 0; pass < abi::kSmoothingPassCount; ++pass) {
    push.level = pass;
    passes_.smooth_columns.recordDescriptors(commands_, bindings_);
    passes_.smooth_columns.recordIndirect(commands_, push, slot_.measured(),
                                          pass < abi::kFirstShortPass
                                              ? offsetof(abi::MeasuredHead, long_groups)
                                              : offsetof(abi::MeasuredHead, short_groups));
    recordComputeBarrier(commands_);
  }
}

void Recording::buildLevels() {
  const uint32_t layer_count = slot_.shape().layerCount();
  for (uint32_t level = abi::kLevelFirst + 1; level <= abi::kLevelLast; ++level) {
    overNodes(passes_.build_level, level, layer_count);
  }
  overNodes(passes_.flatten_entries, abi::kLevelFirst, layer_count);
}

}  // namespace

StructureBuilder::StructureBuilder(const Device& device)
    : convert_color_(makeConvertColor(device)),
      passes_(device, makeStructurePasses),
      preparations_(device, makePrepareColumns),
      apron_passes_(device, makeApronPasses) {}

void StructureBuilder::recordColumns(Commands commands, const StructureSlot& slot,
                                     GpuTimer* timer) const {
  Recording recording(commands, slot, passes_.get(variantOf(slot)),
                      preparations_.get(preparationOf(slot)));
  recordStage(commands, timer, "color", [&] {
    recordClear(commands, slot.measured());
    recordColor(commands, slot);
    recordSurface(commands, slot);
    recordTransferToCompute(commands);
  });
  recordStage(commands, timer, "columns", [&] { recording.prepare(); });
  recordStage(commands, timer, "measure", [&] { recording.measure(); });
  recordStage(commands, timer, "smooth", [&] { recording.smooth(); });
}

void StructureBuilder::recordSurfaces(Commands commands, const StructureSlot& slot,
                                      GpuTimer* timer) const {
  Recording recording(commands, slot, passes_.get(variantOf(slot)),
                      preparations_.get(preparationOf(slot)));
  recordStage(commands, timer, "facets", [&] { recording.buildFacets(); });
  recordStage(commands, timer, "blocks", [&] { recording.buildBlocks(); });
  recordStage(commands, timer, "levels", [&] { recording.buildLevels(); });
  recordComputeToTransfer(commands);
  commands.copy(slot.measured(), slot.measuredReadback(),
                {.size_bytes = slot.measuredReadback().sizeBytes()});
  recordTransferToHost(commands);
}

void StructureBuilder::record(Commands commands, const StructureSlot& slot, GpuTimer* timer) const {
  recordColumns(commands, slot, timer);
  recordSurfaces(commands, slot, timer);
}

void StructureBuilder::recordCube(Commands commands, std::span<const StructureSlot* const> faces,
                                  const Buffer& face_list) const {
  const ApronPasses& passes = apron_passes_.get({});
  const auto recordAprons = [&](const ComputePass& pass) {
    for (uint32_t face = 0; face < faces.size(); ++face) {
      const StructureSlot& slot = *faces[face];
      const uint32_t side_px = slot.shape().depth_px.width - 2 * abi::kCubeApron_px;
      const abi::ApronPush push{.cube = addressWords(face_list.address()),
                                .face = face,
                                .color_format = colorFormat(slot.shape().color_storage)};
      pass.recordDescriptors(commands, describeBindings(slot));
      pass.record(
          commands, push,
          groups(4 * abi::kCubeApron_px * (side_px + abi::kCubeApron_px), abi::kNodeGroupSize));
    }
    recordComputeBarrier(commands);
  };
  for (const StructureSlot* face : faces) recordColumns(commands, *face, nullptr);
  recordAprons(passes.fill_apron);
  for (const StructureSlot* face : faces) recordSurfaces(commands, *face, nullptr);
  recordAprons(passes.color_apron);
}

void StructureBuilder::recordColor(Commands commands, const StructureSlot& slot) const {
  if (slot.colorIsInPlace()) return;
  for (uint32_t i = 0; i < slot.shape().layerCount(); ++i) {
    if (slot.shape().color_storage == ColorStorage::kRgba8Srgb) {
      commands.copy(slot.staging(), slot.color().buffer(i),
                    {.from_offset = slot.staged()[i].color.offset,
                     .to_offset = slot.color().offsetBytes(i),
                     .size_bytes = slot.staged()[i].color.size_bytes});
      continue;
    }
    // Two dimensions of groups: one alone would pass the least limit of 65535 from 2048 x 2048 px
    // on.
    const uint32_t group_count = groups(slot.conversions()[i].texel_count, abi::kNodeGroupSize);
    const uint32_t groups_x = std::min(group_count, 1024u);
    convert_color_.record(commands, slot.conversions()[i], groups_x, groups(group_count, groups_x));
  }
}

}  // namespace viewloom
