// SPDX-License-Identifier: Apache-2.0
// Levels of a layer's min/max pyramid: from inv_z levels 0 and 2; from level n the two above it. An
// invocation takes 4x4 cells.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"

#include "boxes.glsl"
#include "shared/kernel_constants.h"

layout(local_size_x = kNodeGroupSize) in;
layout(constant_id = kIdFree) const bool kFromInvZ = true;
layout(push_constant, scalar) uniform Push {
  BoxesPush push;
};
layout(set = 0, binding = kBindingInvZ) uniform samplerBuffer inv_z_texels;
layout(set = 0, binding = kBindingBoxesOut, scalar) writeonly buffer InvZOut {
  vec4 inv_z_out[];
};
layout(set = 0, binding = kBindingBoxesOut, scalar) writeonly buffer Boxes {
  uint boxes_out[];
};

// Four cells of a row.
struct BoxRow {
  vec4 low;
  vec4 high;
};

// Row of four samples: each is kappa thick. A place without a surface is met nowhere.
BoxRow rowOfSamples(ivec2 size_px, ivec2 pixel) {
  const uint pitch = invZPitch(uint(size_px.x));
  const uint area = invZArea(uint(size_px.x), uint(size_px.y));
  const int at = int(push.layer * area + invZIndex(pitch, uint(pixel.x), pixel.y));
  vec4 inv_z;
  for (int k = 0; k < 4; ++k) inv_z[k] = texelFetch(inv_z_texels, at + k).x;
  const bvec4 is_inside = lessThan(pixel.x + ivec4(0, 1, 2, 3), ivec4(size_px.x));
  inv_z = mix(vec4(kNoSurface), inv_z, pixel.y < size_px.y ? is_inside : bvec4(false));
  const vec4 low = inv_z - max(vec4(push.kappa.x), push.kappa.y * (inv_z - push.kappa.z));
  return BoxRow(mix(vec4(kBoxEmpty), low, greaterThanEqual(inv_z, vec4(0.0))), inv_z);
}

BoxRow rowOfBoxes(uvec2 padded_px, uvec2 cell) {
  const uint at = push.layer * push.box_stride + boxIndex(padded_px, push.level, cell);
  BoxRow row;
  for (uint k = 0u; k < 4u; ++k) {
    const uint word = texelFetch(box_texels, int(at + k)).x;
    const vec2 box = boxOfWord(word, push.level, vec3(0.0));
    row.low[k] = box.x;
    row.high[k] = box.y;
  }
  return row;
}

void main() {
  const ivec2 size_px = ivec2(push.source_size_px & 0xffffu, push.source_size_px >> 16);
  const uvec2 padded_px = paddedSize(uvec2(size_px));
  const uvec2 block = uvec2(gl_GlobalInvocationID.x, gl_WorkGroupID.y);
  if (block.x >= padded_px.x >> (push.level + 2u)) return;
  const uvec2 first = 4u * block;
  vec2 whole = vec2(kBoxEmpty, kNoSurface);
  vec4 above = vec4(0.0);
  for (uint y = 0u; y < 4u; ++y) {
    const uvec2 cell = first + uvec2(0u, y);
    const BoxRow row = kFromInvZ ? rowOfSamples(size_px, ivec2(cell)) : rowOfBoxes(padded_px, cell);
    if (kFromInvZ) inv_z_out[boxIndex(padded_px, 0u, cell) / 4u] = row.high;
    const vec2 low = min(row.low.xz, row.low.yw);
    const vec2 high = max(row.high.xz, row.high.yw);
    const vec4 pair = vec4(low.x, high.x, low.y, high.y);
    if ((y & 1u) == 1u) {
      const vec4 both = vec4(min(above.x, pair.x), max(above.y, pair.y), min(above.z, pair.z),
                             max(above.w, pair.w));
      if (!kFromInvZ) {
        const uint at = boxIndex(padded_px, push.level + 1u, cell / 2u);
        boxes_out[at] = packBox(both.xy);
        boxes_out[at + 1u] = packBox(both.zw);
      }
      whole = vec2(min(whole.x, min(both.x, both.z)), max(whole.y, max(both.y, both.w)));
    }
    above = pair;
  }
  boxes_out[boxIndex(padded_px, push.level + 2u, block)] = packBox(whole);
}
