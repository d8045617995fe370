// SPDX-License-Identifier: Apache-2.0
#include "trace/path_reflector.h"

#include "shaders/merge_paths.h"
#include "shaders/turn_paths.h"
#include "shaders/walk_paths.h"
#include "shared/kernel_constants.h"
#include "shared/lens_abi.h"
#include "trace/band_params.h"

namespace viewloom {
namespace {

constexpr DescriptorSlot kTurnSlots[] = {{abi::kBindingStructure, DescriptorKind::kTexels},
                                         {abi::kBindingStructureHalves, DescriptorKind::kTexels},
                                         {abi::kBindingSurface, DescriptorKind::kTexels},
                                         {abi::kBindingMeasured, DescriptorKind::kUniform},
                                         {abi::kBindingViews, DescriptorKind::kStorage},
                                         {abi::kBindingExtras, DescriptorKind::kUniform},
                                         {abi::kBindingReflection, DescriptorKind::kUniform},
                                         {abi::kBindingAlbedos, DescriptorKind::kStorage},
                                         {abi::kBindingLensPoints, DescriptorKind::kStorage},
                                         {abi::kBindingPaths, DescriptorKind::kStorage}};
constexpr DescriptorSlot kWalkSlots[] = {{abi::kBindingStructure, DescriptorKind::kTexels},
                                         {abi::kBindingStructureHalves, DescriptorKind::kTexels},
                                         {abi::kBindingColor, DescriptorKind::kTexels},
                                         {abi::kBindingMeasured, DescriptorKind::kUniform},
                                         {abi::kBindingViews, DescriptorKind::kStorage},
                                         {abi::kBindingExtras, DescriptorKind::kUniform},
                                         {abi::kBindingReflection, DescriptorKind::kUniform},
                                         {abi::kBindingPaths, DescriptorKind::kStorage},
                                         {abi::kBindingBand, DescriptorKind::kStorage}};
constexpr DescriptorSlot kMergeSlots[] = {{abi::kBindingAnswers, DescriptorKind::kStorage},
                                          {abi::kBindingPaths, DescriptorKind::kStorage},
                                          {abi::kBindingReflected, DescriptorKind::kStorage}};

std::vector<Descriptor> descriptorsOf(const PathPiece& piece) {
  const StructureSlot& structure = piece.structure;
  std::vector<Descriptor> descriptors = piece.params;
  descriptors.push_back(piece.paths);
  descriptors.push_back(structure.measuredDescriptor());
  descriptors.push_back(structure.structure().asTexels(abi::kBindingStructure));
  descriptors.push_back(structure.structure().asHalfTexels(abi::kBindingStructureHalves));
  return descriptors;
}

}  // namespace

const ComputePass& PathReflector::turnPass(const TurnVariant& variant) {
  std::lock_guard lock(mutex_);
  std::unique_ptr<ComputePass>& made = turn_passes_[variant];
  if (!made) {
    const KernelConstant constants[] = {{abi::kIdReadsByAddress, variant.reads_by_address},
                                        {abi::kIdRays, variant.rays},
                                        {abi::kIdThroughLens, variant.through_lens}};
    made = std::make_unique<ComputePass>(*device_,
                                         ComputePassOptions{.spirv = turn_paths_spirv,
                                                            .push_bytes = sizeof(abi::TracePush),
                                                            .constants = constants,
                                                            .descriptors = kTurnSlots,
                                                            .debug_name = "turn paths"});
  }
  return *made;
}

const ComputePass& PathReflector::walkPass(const WalkVariant& variant) {
  std::lock_guard lock(mutex_);
  std::unique_ptr<ComputePass>& made = walk_passes_[variant];
  if (!made) {
    const KernelConstant constants[] = {{abi::kIdReadsByAddress, variant.reads_by_address},
                                        {abi::kIdColorFormat, variant.color_format},
                                        {abi::kIdColorIsScaled, variant.color_is_scaled},
                                        {abi::kIdIsCubeFace, variant.is_cube_face}};
    made = std::make_unique<ComputePass>(*device_,
                                         ComputePassOptions{.spirv = walk_paths_spirv,
                                                            .push_bytes = sizeof(abi::TracePush),
                                                            .constants = constants,
                                                            .descriptors = kWalkSlots,
                                                            .debug_name = "walk paths"});
  }
  return *made;
}

const ComputePass& PathReflector::mergePass() {
  std::lock_guard lock(mutex_);
  if (!merge_pass_) {
    merge_pass_ = std::make_unique<ComputePass>(
        *device_, ComputePassOptions{.spirv = merge_paths_spirv,
                                     .push_bytes = sizeof(abi::MergePathsPush),
                                     .descriptors = kMergeSlots,
                                     .debug_name = "merge paths"});
  }
  return *merge_pass_;
}

void PathReflector::recordTurns(Commands commands, const PathPiece& piece) {
  const ComputePass& turn = turnPass({.reads_by_address = piece.structure.readsByAddress(),
                                      .rays = piece.rays,
                                      .through_lens = piece.through_lens});
  std::vector<Descriptor> descriptors = descriptorsOf(piece);
  descriptors.push_back(piece.lens_points);
  descriptors.push_back(albedos_.descriptor());
  descriptors.push_back(piece.structure.surface()->asTexels(abi::kBindingSurface));
  turn.recordDescriptors(commands, descriptors);
  turn.record(commands, piece.push, groupCount(piece.push.atlas_width_px), piece.rows.row_count);
}

void PathReflector::recordWalk(Commands commands, const PathPiece& piece) {
  const FrameShape& shape = piece.structure.shape();
  const ComputePass& walk = walkPass({.reads_by_address = piece.structure.readsByAddress(),
                                      .color_format = colorFormat(shape.color_storage),
                                      .color_is_scaled = shape.colorIsScaled(),
                                      .is_cube_face = shape.is_cube_face});
  std::vector<Descriptor> descriptors = descriptorsOf(piece);
  descriptors.push_back(piece.structure.color().asTexels(abi::kBindingColor));
  descriptors.push_back(piece.answers);
  walk.recordDescriptors(commands, descriptors);
  walk.record(commands, piece.push, groupCount(piece.push.atlas_width_px), piece.rows.row_count);
}

void PathReflector::recordMerge(Commands commands, const MergedPaths& merged) {
  const ComputePass& merge = mergePass();
  const Descriptor descriptors[] = {merged.answers, merged.paths, merged.reflected};
  merge.recordDescriptors(commands, descriptors);
  merge.record(commands, merged.push, groupCount(merged.push.atlas_width_px),
               merged.rows.row_count);
}

}  // namespace viewloom
