// SPDX-License-Identifier: Apache-2.0
// Packs a traced band as the planes of Y'CbCr that JPEG takes (server/core/display/color_form.h):
// less to read back. An invocation takes 8 px of a row, or of the two rows of 4:2:0: whole words of
// every plane.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#include "shared/kernel_constants.h"
#include "shared/trace_abi.h"
#include "shared/ycbcr.h"

layout(local_size_x = kPackGroupSize) in;
layout(constant_id = kIdIs420) const bool kIs420 = true;
layout(push_constant, scalar) uniform Push {
  PackPush push;
};
layout(set = 0, binding = kBindingBand, scalar) readonly buffer Band {
  uint band[];
};
layout(set = 0, binding = kBindingPlanes, scalar) writeonly buffer Planes {
  uint planes[];
};

// Codes beyond the image: those of the last pixel of its row and of its column.
vec3 codesAt(uint x, uint y) {
  const uint row = min(y, push.row_count - 1u);
  const uint rgb = band[row * push.width_px + min(x, push.width_px - 1u)];
  return vec3(rgb & 255u, rgb >> 8 & 255u, rgb >> 16 & 255u);
}

uint luma(vec3 codes) {
  return lumaOf(codes.r, codes.g, codes.b);
}

// Cb, Cr.
uvec2 chroma(vec3 codes) {
  return uvec2(cbOf(codes.r, codes.g, codes.b), crOf(codes.r, codes.g, codes.b));
}

void pack444(uint x, uint y) {
  const uint words = push.luma_stride / 4u * push.row_count;  // of a plane
  for (uint word = 0u; word < 2u; ++word) {
    uvec3 packed = uvec3(0u);
    for (uint i = 0u; i < 4u; ++i) {
      const vec3 codes = codesAt(x + 4u * word + i, y);
      packed |= uvec3(luma(codes), chroma(codes)) << (8u * i);
    }
    const uint at = (push.luma_stride * y + x) / 4u + word;
    planes[at] = packed.x;
    planes[at + words] = packed.y;
    planes[at + 2u * words] = packed.z;
  }
}

void pack420(uint x, uint y) {
  uvec2 upper = uvec2(0u);  // luma: four px, and the next four
  uvec2 lower = uvec2(0u);
  uvec2 means = uvec2(0u);  // Cb, Cr
  for (uint i = 0u; i < 4u; ++i) {
    uvec2 sums = uvec2(0u);
    for (uint side = 0u; side < 2u; ++side) {
      const uint column = 2u * i + side;
      const vec3 above = codesAt(x + column, y);
      const vec3 below = codesAt(x + column, y + 1u);
      const uint shift = 8u * (column & 3u);
      upper[column / 4u] |= luma(above) << shift;
      lower[column / 4u] |= luma(below) << shift;
      sums += chroma(above) + chroma(below);
    }
    means |= uvec2(meanChroma(sums.x, i), meanChroma(sums.y, i)) << (8u * i);
  }
  const uint row_words = push.luma_stride / 4u;
  const uint at = row_words * y + x / 4u;
  planes[at] = upper.x;
  planes[at + 1u] = upper.y;
  if (y + 1u < push.row_count) {
    planes[at + row_words] = lower.x;
    planes[at + row_words + 1u] = lower.y;
  }
  const uint chroma_row_words = row_words / 2u;
  const uint chroma_at = row_words * push.row_count + chroma_row_words * (y / 2u) + x / 8u;
  planes[chroma_at] = means.x;
  planes[chroma_at + chroma_row_words * ((push.row_count + 1u) / 2u)] = means.y;
}

void main() {
  const uint x = 8u * gl_GlobalInvocationID.x;
  if (x >= push.luma_stride) return;
  if (kIs420)
    pack420(x, 2u * gl_WorkGroupID.y);
  else
    pack444(x, gl_WorkGroupID.y);
}
