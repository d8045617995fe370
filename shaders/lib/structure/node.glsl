// SPDX-License-Identifier: Apache-2.0
// Nodes of the pyramid: 8 bytes that are either a plane with its error or a box.
//
//   plane  x: bit 31 = 1 | bits 30..9 the upper bits of inv_z at the centre | bits 8..3 error |
//   2..0 level
//          y: two slopes (lib/structure/facet.glsl)
//   box    x: bit 31 = 0 | the least inv_z, its low 3 bits dropped | bits 2..0 level
//          y: the largest inv_z (kNoSurface: nothing in it)
//
// The level is the node's own, so a copy of a large plane still knows its size. The least inv_z of
// a box with a hole is 0: nothing can be known to be behind it everywhere.
#ifndef VIEWLOOM_LIB_STRUCTURE_NODE_GLSL_
#define VIEWLOOM_LIB_STRUCTURE_NODE_GLSL_

#include "lib/structure/facet.glsl"

struct Node {
  bool is_plane;
  uint level;
  float inv_z;  // plane: at the block's centre
  vec2 slope;   // plane
  float error;  // plane: no facet of the block is further away anywhere, 1/m
  vec2 box;     // box: least and largest inv_z
};

// Errors keep 5 bits of exponent and one of mantissa of their binary32, rounded up: two steps an
// octave, 2^-28 .. 1.5 * 2^3 1/m.
const uint kErrorShift = 22u;
const uint kErrorFirst = 99u << 1u;  // of 2^-28

uint errorCode(float error) {
  const uint bits = floatBitsToUint(max(error, 1e-12));
  const int code = int((bits + (1u << kErrorShift) - 1u) >> kErrorShift) - int(kErrorFirst);
  return uint(clamp(code, 0, 63));
}

float errorOfCode(uint code) {
  return uintBitsToFloat((code + kErrorFirst) << kErrorShift);
}

// Larger errors cannot be stated, so such a plane must not be made.
const float kErrorMax = 12.0;

uvec2 packPlane(uint level, float inv_z, vec2 slope, uint error_code) {
  const uint center = floatBitsToUint(inv_z) & 0x7ffffe00u;
  return uvec2(0x80000000u | center | (error_code << 3) | level, packSlopes(slope));
}

uvec2 packBox(uint level, vec2 box) {
  return uvec2((floatBitsToUint(max(box.x, 0.0)) & 0x7ffffff8u) | level, floatBitsToUint(box.y));
}

bool isPlane(uvec2 bits) {
  return (bits.x & 0x80000000u) != 0u;
}

float planeCenter(uvec2 bits) {
  return uintBitsToFloat(bits.x & 0x7ffffe00u);
}

float planeError(uvec2 bits) {
  return errorOfCode((bits.x >> 3) & 63u);
}

Node unpackNode(uvec2 bits) {
  Node node;
  node.is_plane = isPlane(bits);
  node.level = bits.x & 7u;
  node.inv_z = planeCenter(bits);
  node.slope = unpackSlopes(bits.y);
  node.error = planeError(bits);
  node.box = vec2(uintBitsToFloat(bits.x & 0x7ffffff8u), uintBitsToFloat(bits.y));
  return node;
}

// Box of everything a node may hold. For a plane: its corners, and its error on top.
vec2 nodeBox(Node node) {
  if (!node.is_plane) return node.box;
  const float half_size = 0.5 * float(1u << node.level);
  precise const float half_range =
      (half_size * (abs(node.slope.x) + abs(node.slope.y)) + node.error) *
      (1.0 + 2.384185791015625e-7);
  precise const float low = (node.inv_z - half_range) * (1.0 - 2.384185791015625e-7);
  precise const float high = (node.inv_z + half_range) * (1.0 + 2.384185791015625e-7);
  return vec2(max(0.0, low), high);
}

#endif  // VIEWLOOM_LIB_STRUCTURE_NODE_GLSL_
