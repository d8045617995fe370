// SPDX-License-Identifier: Apache-2.0
// Bindings of every kernel that sends rays on from the surfaces of a structure.
#pragma once

#include <initializer_list>
#include <span>
#include <vector>

#include "gpu/descriptor.h"
#include "structure/structure_slot.h"
#include "trace/albedos.h"
#include "trace/band_rays.h"
#include "trace/trace_slot.h"

namespace viewloom {

// Slots of such a kernel, with its own ones behind them.
std::vector<DescriptorSlot> mirrorSlots(std::initializer_list<DescriptorSlot> own_slots);

// Descriptors for those slots: the structure with its own colour, its surfaces where it mirrors,
// the albedos. `params` are of the walk: its tiles, its extras with the records,
// abi::ReflectionSettings, and the points of the lens.
std::vector<Descriptor> mirrorDescriptors(const StructureSlot& structure,
                                          std::span<const Descriptor> params, Albedos& albedos);

// Those params of a walk, in a slot. `first_walk`: in whose camera rays are told.
std::vector<Descriptor> mirrorParams(const Walk& walk, uint32_t first_walk, const TraceSlot& slot);

}  // namespace viewloom
