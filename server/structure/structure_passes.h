// SPDX-License-Identifier: Apache-2.0
// The pipelines of a build, specialised to how a structure lies in memory.
#pragma once

#include <compare>
#include <vector>

#include "gpu/compute_pass.h"

namespace viewloom {

struct StructureVariant {
  bool reads_by_address = false;
  bool writes_by_address = false;
  uint32_t layer_count = 1;  // passes over whole columns unroll their loops

  auto operator<=>(const StructureVariant&) const = default;
};

struct StructurePasses {
  StructurePasses(const Device& device, const StructureVariant& variant);

  std::vector<ComputePass> linearise_depth;  // [abi::kDepthSample...]
  ComputePass sort_columns;
  ComputePass measure_depth;
  ComputePass settle_tolerance;
  ComputePass build_facets;
  ComputePass build_links;
  ComputePass build_blocks;
  ComputePass build_level;
  ComputePass flatten_entries;
};

ComputePass makeConvertColor(const Device& device);

}  // namespace viewloom
