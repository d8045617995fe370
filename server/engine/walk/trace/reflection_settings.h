// SPDX-License-Identifier: Apache-2.0
// Parameters of the kernels of reflections for a display and a structure.
#pragma once

#include "frame/camera.h"
#include "picture/trace_job.h"
#include "shared/reflection_abi.h"
#include "structure/structure_slot.h"

namespace viewloom {

// Linear light.
abi::vec3 environmentOf(const ReflectionSpec& spec);

// Settings for a walk of a job that reflects. `first_walk`: the walk whose camera rays are given
// in.
abi::ReflectionSettings reflectionSettings(const StructureSlot& structure, const TraceJob& job,
                                           uint32_t walk, uint32_t first_walk);

}  // namespace viewloom
