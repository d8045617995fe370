// SPDX-License-Identifier: Apache-2.0
// Arrays by address. Every buffer is reached this way, so none is bound by the descriptor limit.
#ifndef VIEWLOOM_LIB_MEMORY_GLSL_
#define VIEWLOOM_LIB_MEMORY_GLSL_

#include "shared/structure_abi.h"

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer MeasuredRef { Measured value; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer FloatRef { float at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer UintRef { uint at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer Uvec2Ref { uvec2 at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 2) buffer Uint16Ref { uint16_t at[]; };

// One of four addresses without an array in memory.
Address pickAddress(Address addresses[kLayerCountMax], uint layer) {
  const Address low = layer == 0u ? addresses[0] : addresses[1];
  const Address high = layer == 2u ? addresses[2] : addresses[3];
  return layer < 2u ? low : high;
}

#endif  // VIEWLOOM_LIB_MEMORY_GLSL_
