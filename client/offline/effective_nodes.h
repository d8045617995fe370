// SPDX-License-Identifier: Apache-2.0
// How many nodes of a structure a walk has a use for: what it would be stored in without gaps.
#pragma once

#include <cstdint>
#include <span>

#include "shared/structure_abi.h"
#include "structure/structure_layout.h"

namespace viewloom {

// The largest planes, the boxes above them, and the facets of what is a box at 4x4 px; copies and
// whatever lies below a plane are left out. cells: those of one layer, built, as on the device.
uint64_t effectiveNodeCount(std::span<const abi::uvec2> cells, const StructureLayout& layout);

}  // namespace viewloom
