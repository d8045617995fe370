// SPDX-License-Identifier: Apache-2.0
#include "structure/structure_passes.h"

#include "shaders/build_blocks.h"
#include "shaders/build_facets.h"
#include "shaders/build_level.h"
#include "shaders/color_apron.h"
#include "shaders/convert_color.h"
#include "shaders/fill_apron.h"
#include "shaders/flatten_entries.h"
#include "shaders/measure_depth.h"
#include "shaders/measure_range.h"
#include "shaders/prepare_columns.h"
#include "shaders/settle_range.h"
#include "shaders/settle_tolerance.h"
#include "shaders/smooth_columns.h"
#include "shared/cube_abi.h"
#include "shared/kernel_constants.h"
#include "shared/structure_abi.h"

namespace viewloom {
namespace {

constexpr DescriptorSlot kSlots[] = {{abi::kBindingStructure, DescriptorKind::kTexels},
                                     {abi::kBindingStructureHalves, DescriptorKind::kTexels},
                                     {abi::kBindingInvZ, DescriptorKind::kTexels},
                                     {abi::kBindingSamples, DescriptorKind::kTexels},
                                     {abi::kBindingInvZOut, DescriptorKind::kStorage},
                                     {abi::kBindingStructureOut, DescriptorKind::kStorage},
                                     {abi::kBindingDepthPlanes, DescriptorKind::kUniform},
                                     {abi::kBindingMeasured, DescriptorKind::kUniform}};

// `own`: the specialisation constants of this pass.
ComputePass makePass(const Device& device, const StructureVariant& variant,
                     std::span<const uint32_t> spirv, std::initializer_list<KernelConstant> own,
                     const char* name) {
  std::vector<KernelConstant> constants = {{abi::kIdReadsByAddress, variant.reads_by_address},
                                           {abi::kIdWritesByAddress, variant.writes_by_address}};
  constants.insert(constants.end(), own);
  return ComputePass(device, {.spirv = spirv,
                              .push_bytes = sizeof(abi::BuildPush),
                              .takes_parts = true,
                              .constants = constants,
                              .descriptors = kSlots,
                              .debug_name = name});
}

ComputePass makeApronPass(const Device& device, std::span<const uint32_t> spirv, const char* name) {
  constexpr KernelConstant kByAddress[] = {{abi::kIdReadsByAddress, 1},
                                           {abi::kIdWritesByAddress, 1}};
  return ComputePass(device, {.spirv = spirv,
                              .push_bytes = sizeof(abi::ApronPush),
                              .constants = kByAddress,
                              .descriptors = kSlots,
                              .debug_name = name});
}

}  // namespace

StructurePasses makeStructurePasses(const Device& device, const StructureVariant& variant) {
  const auto make = [&](std::span<const uint32_t> spirv, const char* name) {
    return makePass(device, variant, spirv, {}, name);
  };
  const auto makeOfColumns = [&](std::span<const uint32_t> spirv, const char* name) {
    return makePass(device, variant, spirv, {{abi::kIdLayerCount, variant.layer_count}}, name);
  };
  return {.measure_depth = make(measure_depth_spirv, "measure depth"),
          .settle_range = make(settle_range_spirv, "settle range"),
          .measure_range = make(measure_range_spirv, "measure range"),
          .settle_tolerance = make(settle_tolerance_spirv, "settle tolerance"),
          .smooth_columns = makeOfColumns(smooth_columns_spirv, "smooth columns"),
          .build_facets = makeOfColumns(build_facets_spirv, "build facets"),
          .build_blocks = makeOfColumns(build_blocks_spirv, "build blocks"),
          .build_level = make(build_level_spirv, "build level"),
          .flatten_entries = make(flatten_entries_spirv, "flatten entries")};
}

ApronPasses makeApronPasses(const Device& device, const std::monostate&) {
  return {.fill_apron = makeApronPass(device, fill_apron_spirv, "fill apron"),
          .color_apron = makeApronPass(device, color_apron_spirv, "color apron")};
}

ComputePass makePrepareColumns(const Device& device, const PrepareVariant& variant) {
  return makePass(device, variant.structure, prepare_columns_spirv,
                  {{abi::kIdLayerCount, variant.structure.layer_count},
                   {abi::kIdSampleType, variant.sample_type},
                   {abi::kIdHasRayDistance, variant.has_ray_distance}},
                  "prepare columns");
}

ComputePass makeConvertColor(const Device& device) {
  return ComputePass(device, {.spirv = convert_color_spirv,
                              .push_bytes = sizeof(abi::ConvertColorPush),
                              .takes_parts = true,
                              .descriptors = kSlots,
                              .debug_name = "convert color"});
}

}  // namespace viewloom
