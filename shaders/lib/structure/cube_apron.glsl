// SPDX-License-Identifier: Apache-2.0
// Where the px of the apron of a face lie on the neighbouring faces (shaders/structure.md, Cube
// maps). In integers, and with exact quotients: all who ask name the same sample and place.
#ifndef VIEWLOOM_LIB_STRUCTURE_CUBE_APRON_GLSL_
#define VIEWLOOM_LIB_STRUCTURE_CUBE_APRON_GLSL_

#include "shared/cube_abi.h"
#include "shared/quotient.h"

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer CubeRef {
  CubeFaceList list;
};

// A place on a face.
struct FacePlace {
  uint face;
  ivec2 sample_px;  // the nearest
  vec2 offset_px;   // from it
  bool is_along_x;  // the edge between the two faces
  float nearness;   // inv_z of the other face for one of this face
};

// `apron_index`: of a px in the ring around a face, 0..4 apron (side + apron) - 1, row after row.
// False: there is none.
bool apronPixel(uint apron_index, int side, out ivec2 pixel) {
  const int apron = int(kCubeApron_px);
  const int whole = side + 2 * apron;
  const int band = apron * whole;  // above the face, and below it
  const int index = int(apron_index);
  const int beside = index - 2 * band;
  pixel = index < band       ? ivec2(index % whole, index / whole)
          : index < 2 * band ? ivec2(index % whole, index / whole + side)
                             : ivec2(beside % (2 * apron), apron + beside / (2 * apron));
  if (index >= 2 * band && pixel.x >= apron) pixel.x += side;
  return index < 4 * apron * (side + apron);
}

// Place of a pixel on the other face. For side N, it lies in direction N forward + p.x right + p.y
// down, whose largest part selects the face.
FacePlace placeOf(CubeRef cube, uint face, ivec2 pixel) {
  const int side = int(cube.list.side_px);
  const ivec2 p = 2 * (pixel - int(kCubeApron_px)) + 1 - side;
  const vec3 right = cube.list.faces[face].right;
  const vec3 down = cube.list.faces[face].down;
  const vec3 forward = cube.list.faces[face].forward;
  const ivec3 direction = ivec3(float(side) * forward + float(p.x) * right + float(p.y) * down);
  const bool is_across_x = abs(p.x) >= abs(p.y);
  const ivec3 axis = ivec3(is_across_x ? right * sign(float(p.x)) : down * sign(float(p.y)));
  FacePlace place;
  place.face = 2u * uint(abs(axis.y) + 2 * abs(axis.z)) + (axis.x + axis.y + axis.z < 0 ? 1u : 0u);
  const int depth = max(abs(p.x), abs(p.y));
  const ivec3 other_right = ivec3(cube.list.faces[place.face].right);
  const ivec3 other_down = ivec3(cube.list.faces[place.face].down);
  const ivec3 along_x = direction * other_right;
  const ivec3 along_y = direction * other_down;
  const ivec2 beside = ivec2(along_x.x + along_x.y + along_x.z, along_y.x + along_y.y + along_y.z);
  const ivec2 scaled = side * (beside + depth);  // of 2 depth a px
  place.sample_px = min(scaled / (2 * depth), ivec2(side - 1));
  const ivec2 rest = scaled - place.sample_px * (2 * depth);
  const float all_px = float(2 * depth);
  const vec2 share = vec2(exactQuotient(float(rest.x), all_px),
                          exactQuotient(float(rest.y), all_px));
  place.offset_px = share - 0.5;
  const vec3 leading = abs(vec3(other_right) * forward);
  place.is_along_x = leading.x + leading.y + leading.z < 0.5;
  place.nearness = exactQuotient(float(depth), float(side));
  return place;
}

#endif  // VIEWLOOM_LIB_STRUCTURE_CUBE_APRON_GLSL_
