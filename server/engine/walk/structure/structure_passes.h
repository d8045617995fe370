// SPDX-License-Identifier: Apache-2.0
// The pipelines of a build, specialised to how a structure lies in memory.
#pragma once

#include <compare>
#include <variant>

#include "gpu/compute_pass.h"
#include "shared/structure_abi.h"

namespace viewloom {

struct StructureVariant {
  bool reads_by_address = false;
  bool writes_by_address = false;
  uint32_t layer_count = 1;  // passes over whole columns unroll their loops

  auto operator<=>(const StructureVariant&) const = default;
};

struct StructurePasses {
  ComputePass measure_depth;
  ComputePass settle_range;
  ComputePass measure_range;
  ComputePass settle_tolerance;
  ComputePass smooth_columns;
  ComputePass build_facets;
  ComputePass build_blocks;
  ComputePass build_level;
  ComputePass flatten_entries;
};

// The first pass also differs by what the depth samples are.
struct PrepareVariant {
  StructureVariant structure;
  uint32_t sample_type = abi::kDepthSampleF32;  // kDepthSample..., of all layers
  bool has_ray_distance = false;                // some layer states distances along rays

  auto operator<=>(const PrepareVariant&) const = default;
};

// Passes for the aprons of cube maps: for any layers, reached by address.
struct ApronPasses {
  ComputePass fill_apron;
  ComputePass color_apron;
};

StructurePasses makeStructurePasses(const Device& device, const StructureVariant& variant);
ApronPasses makeApronPasses(const Device& device, const std::monostate&);
ComputePass makePrepareColumns(const Device& device, const PrepareVariant& variant);
ComputePass makeConvertColor(const Device& device);

}  // namespace viewloom
