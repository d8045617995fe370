// SPDX-License-Identifier: Apache-2.0
// The arrays of a structure by what its frame needs of them.
#pragma once

#include "structure/frame_shape.h"
#include "structure/layered_buffer.h"

namespace viewloom {

// Where the device's memory is the CPU's, colour that stays as it came is written in its place.
bool writesColorInPlace(const Device& device, const FrameShape& shape);

LayeredBufferOptions colorOptions(const Device& device, const FrameShape& shape);
LayeredBufferOptions meanColorOptions(const Device& device, const FrameShape& shape);
LayeredBufferOptions surfaceOptions(const Device& device, const FrameShape& shape);
LayeredBufferOptions invZOptions(const Device& device, const FrameShape& shape);
LayeredBufferOptions structureOptions(const Device& device, const FrameShape& shape);

// All arrays of a structure are divided if one has to be, or if the upload is too large for a
// texel view.
bool mustDivide(const Device& device, const FrameShape& shape);

}  // namespace viewloom
