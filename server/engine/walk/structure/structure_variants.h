// SPDX-License-Identifier: Apache-2.0
// The variants of kernels that build a structure.
#pragma once

#include <vector>

#include "structure/structure_passes.h"
#include "structure/structure_slot.h"

namespace viewloom {

// Those that the slot's uploaded part takes.
StructureVariant variantOf(const StructureSlot& slot);
PrepareVariant preparationOf(const StructureSlot& slot);
// The same of a slot that a part of this frame would get.
PrepareVariant preparationOf(const Device& device, const Frame& frame, const SourcePart& part);

// Those of frames that are likely to come, the likeliest first: pictures that fit into bindings.
std::vector<PrepareVariant> likelyPreparations();

}  // namespace viewloom
