// SPDX-License-Identifier: Apache-2.0
// Four columns of inv_z, side by side.
#ifndef VIEWLOOM_LIB_STRUCTURE_COLUMNS_GLSL_
#define VIEWLOOM_LIB_STRUCTURE_COLUMNS_GLSL_

#include "lib/structure/layer_count.glsl"
#include "lib/structure/structure_access.glsl"

struct Columns {
  vec4 inv_z[kLayerCountMax];
};

// The surface of each column whose inv_z is nearest; kNoSurface where there is none.
vec4 nearestIn(Columns columns, vec4 inv_z) {
  vec4 nearest = columns.inv_z[0];
  for (uint i = 1u; i < kLayerCount; ++i) {
    const vec4 other = columns.inv_z[i];
    const bvec4 is_nearer = lessThan(abs(other - inv_z), abs(nearest - inv_z));
    nearest = mix(nearest, mix(nearest, other, is_nearer), greaterThanEqual(other, vec4(0.0)));
  }
  return nearest;
}

#endif  // VIEWLOOM_LIB_STRUCTURE_COLUMNS_GLSL_
