// SPDX-License-Identifier: Apache-2.0
// Arrays, through bindings where they fit and by address where they do not.
#ifndef VIEWLOOM_LIB_MEMORY_GLSL_
#define VIEWLOOM_LIB_MEMORY_GLSL_

#include "shared/kernel_constants.h"
#include "shared/structure_abi.h"

layout(constant_id = kIdReadsByAddress) const bool kReadByAddress = false;
layout(constant_id = kIdWritesByAddress) const bool kWriteByAddress = false;

layout(set = 0, binding = kBindingStructure) uniform usamplerBuffer structure_texels;
layout(set = 0, binding = kBindingStructureHalves) uniform usamplerBuffer structure_halves;
layout(set = 0, binding = kBindingColor) uniform usamplerBuffer color_texels;
layout(set = 0, binding = kBindingInvZ) uniform samplerBuffer inv_z_texels;
layout(set = 0, binding = kBindingInvZOut, scalar) writeonly buffer InvZOut {
  vec4 inv_z_out[];
};
layout(set = 0, binding = kBindingStructureOut, scalar) writeonly buffer StructureOut {
  uvec2 structure_out[];
};
layout(set = 0, binding = kBindingMeasured, scalar) uniform MeasuredBlock {
  MeasuredHead measured_head;
};

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer MeasuredRef {
  Measured value;
};
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer FloatRef {
  float at[];
};
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer Vec4Ref {
  vec4 at[];
};
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer UintRef {
  uint at[];
};
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer Uvec2Ref {
  uvec2 at[];
};

// One of four addresses without an array in memory.
Address pickAddress(Address addresses[kLayerCountMax], uint layer) {
  const Address low = layer == 0u ? addresses[0] : addresses[1];
  const Address high = layer == 2u ? addresses[2] : addresses[3];
  return layer < 2u ? low : high;
}

// `area`: of a layer, with its guard.
float loadInvZ(Address inv_z[kLayerCountMax], uint layer, uint area, uint index) {
  if (kReadByAddress) return FloatRef(pickAddress(inv_z, layer)).at[index];
  return texelFetch(inv_z_texels, int(layer * area + index)).x;
}

// Four px of a row; `index` is a multiple of 4.
void storeInvZ(Address inv_z, uint layer, uint area, uint index, vec4 value) {
  if (kWriteByAddress)
    Vec4Ref(inv_z).at[index / 4u] = value;
  else
    inv_z_out[(layer * area + index) / 4u] = value;
}

#endif  // VIEWLOOM_LIB_MEMORY_GLSL_
