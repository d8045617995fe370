// SPDX-License-Identifier: Apache-2.0
// Px that an invocation of the walk takes one after the other.
#pragma once

#include <cstdint>

#include "display/atlas_layout.h"
#include "gpu/device.h"
#include "structure/structure_slot.h"

namespace viewloom {

// No run has fewer, but for the last of a row of a tile.
inline constexpr uint32_t kRunPixelsMin = 8;

// Length of a run of neighbours in a row of one view. Views see about as much as the source.
uint32_t pixelsOfRun(const DeviceInfo& device, const StructureSlot& structure,
                     const AtlasLayout& layout);
// Whether neighbouring invocations are of neighbouring views.
bool lanesAreViews(const AtlasLayout& layout);

}  // namespace viewloom
