// SPDX-License-Identifier: Apache-2.0
#include "structure/structure_passes.h"

#include "shaders/build_blocks.h"
#include "shaders/build_facets.h"
#include "shaders/build_level.h"
#include "shaders/build_links.h"
#include "shaders/convert_color.h"
#include "shaders/flatten_entries.h"
#include "shaders/linearise_depth.h"
#include "shaders/measure_depth.h"
#include "shaders/settle_tolerance.h"
#include "shaders/sort_columns.h"
#include "shared/structure_abi.h"

namespace viewloom {
namespace {

constexpr DescriptorSlot kSlots[] = {
    {abi::kBindingStructure, DescriptorKind::kTexels},
    {abi::kBindingInvZ, DescriptorKind::kTexels},
    {abi::kBindingSamples, DescriptorKind::kStorage},
    {abi::kBindingInvZOut, DescriptorKind::kStorage},
    {abi::kBindingStructureOut, DescriptorKind::kStorage},
    {abi::kBindingLinksOut, DescriptorKind::kStorage},
    {abi::kBindingMeasured, DescriptorKind::kUniform}};

// `own`: the last specialisation constant, for those passes that have one.
ComputePass makePass(const Device& device, const StructureVariant& variant,
                     std::span<const uint32_t> spirv, uint32_t own, const char* name,
                     uint32_t push_bytes = sizeof(abi::BuildPush)) {
  static_assert(abi::kOwnConstants == 2);
  const uint32_t constants[] = {variant.reads_by_address, variant.writes_by_address, own};
  return ComputePass(device, {.spirv = spirv,
                              .push_bytes = push_bytes,
                              .specialization = constants,
                              .descriptors = kSlots,
                              .debug_name = name});
}

std::vector<ComputePass> makeLinearise(const Device& device, const StructureVariant& variant) {
  std::vector<ComputePass> passes;
  for (uint32_t type : {abi::kDepthSampleF32, abi::kDepthSampleF16, abi::kDepthSampleU16}) {
    passes.push_back(makePass(device, variant, linearise_depth_spirv, type, "linearise depth",
                              sizeof(abi::LinearisePush)));
  }
  return passes;
}

}  // namespace

StructurePasses::StructurePasses(const Device& device, const StructureVariant& variant)
    : linearise_depth(makeLinearise(device, variant)),
      sort_columns(
          makePass(device, variant, sort_columns_spirv, variant.layer_count, "sort columns")),
      measure_depth(makePass(device, variant, measure_depth_spirv, 0, "measure depth")),
      settle_tolerance(makePass(device, variant, settle_tolerance_spirv, 0, "settle tolerance")),
      build_facets(
          makePass(device, variant, build_facets_spirv, variant.layer_count, "build facets")),
      build_links(makePass(device, variant, build_links_spirv, variant.layer_count, "build links")),
      build_blocks(makePass(device, variant, build_blocks_spirv, 0, "build blocks")),
      build_level(makePass(device, variant, build_level_spirv, 0, "build level")),
      flatten_entries(makePass(device, variant, flatten_entries_spirv, 0, "flatten entries")) {}

ComputePass makeConvertColor(const Device& device) {
  return ComputePass(device, {.spirv = convert_color_spirv,
                              .push_bytes = sizeof(abi::ConvertColorPush),
                              .descriptors = kSlots,
                              .debug_name = "convert color"});
}

}  // namespace viewloom
