// SPDX-License-Identifier: Apache-2.0
// What the kernels of reflections are told of a display and of the structure they work on.
#pragma once

#include "frame/camera.h"
#include "picture/trace_job.h"
#include "shared/reflection_abi.h"
#include "structure/structure_slot.h"

namespace viewloom {

// Linear light.
abi::vec3 environmentOf(const ReflectionSpec& spec);

// Of a walk of a job that reflects. `first_walk`: in whose camera rays are told.
abi::ReflectionSettings reflectionSettings(const StructureSlot& structure, const TraceJob& job,
                                           uint32_t walk, uint32_t first_walk);

}  // namespace viewloom
