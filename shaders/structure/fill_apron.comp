// SPDX-License-Identifier: Apache-2.0
// Fills the apron of a face of a cube map: columns of the neighbouring faces, seen by its own
// pinhole. An invocation a px.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#include "lib/structure/cube_apron.glsl"
#include "lib/fault.glsl"
#include "lib/memory.glsl"

layout(local_size_x = kNodeGroupSize) in;
layout(push_constant, scalar) uniform Push {
  ApronPush push;
};

CubeRef cube;

uint indexAt(ivec2 pixel) {
  const uint width = cube.list.side_px + 2u * kCubeApron_px;
  return invZIndex(invZPitch(width), uint(pixel.x), pixel.y);
}

// A sample of a face without its apron; no surface where there is none.
float sampleAt(uint face, uint layer, ivec2 sample_px) {
  const bool exists = all(greaterThanEqual(sample_px, ivec2(0))) &&
                      all(lessThan(sample_px, ivec2(cube.list.side_px)));
  if (!exists) return kNoSurface;
  return FloatRef(cube.list.faces[face].inv_z[layer]).at[indexAt(sample_px + int(kCubeApron_px))];
}

// The surface of a column whose inv_z is nearest; kNoSurface if there is none.
float nearestIn(uint face, ivec2 sample_px, float inv_z) {
  float nearest = kNoSurface;
  for (uint layer = 0u; layer < cube.list.layer_count; ++layer) {
    const float other = sampleAt(face, layer, sample_px);
    const bool is_nearer = nearest < 0.0 || abs(other - inv_z) < abs(nearest - inv_z);
    nearest = other >= 0.0 && is_nearer ? other : nearest;
  }
  return nearest;
}

float minmod(float a, float b) {
  return a * b <= 0.0 ? 0.0 : abs(a) <= abs(b) ? a : b;
}

// Slope as of a facet, before it is rounded.
float slopeAlong(uint face, ivec2 sample_px, ivec2 step, float inv_z) {
  const float before = nearestIn(face, sample_px - step, inv_z);
  const float after = nearestIn(face, sample_px + step, inv_z);
  if (before >= 0.0 && after >= 0.0) return minmod(inv_z - before, after - inv_z);
  const float neighbor = max(before, after);
  const ivec2 outward = after >= 0.0 ? step : -step;
  const float beyond = nearestIn(face, sample_px + 2 * outward, neighbor);
  if (neighbor < 0.0 || beyond < 0.0) return 0.0;
  const float slope = minmod(neighbor - inv_z, beyond - neighbor);
  return after >= 0.0 ? slope : -slope;
}

void main() {
  cube = CubeRef(push.cube);
  ivec2 pixel;
  if (!apronPixel(gl_GlobalInvocationID.x, int(cube.list.side_px), pixel)) return;
  const int whole = int(cube.list.side_px + 2u * kCubeApron_px);
  const ivec2 seen_px = hasFault(kFaultFaceTurned) ? whole - 1 - pixel : pixel;
  const FacePlace place = placeOf(cube, push.face, seen_px);
  float in_front = 3.4e38;
  float nearest = 0.0;
  for (uint layer = 0u; layer < cube.list.layer_count; ++layer) {
    const float inv_z = sampleAt(place.face, layer, place.sample_px);
    float seen = kNoSurface;
    if (inv_z >= 0.0) {
      const float slope_x = slopeAlong(place.face, place.sample_px, ivec2(1, 0), inv_z);
      const float slope_y = slopeAlong(place.face, place.sample_px, ivec2(0, 1), inv_z);
      precise const float bent = slope_x * place.offset_px.x + slope_y * place.offset_px.y;
      precise const float there = inv_z + bent;
      precise const float here = max(there, 0.0) * place.nearness;
      // Planes may cross beside their samples; columns stay in order.
      seen = min(here, in_front);
      in_front = seen;
    }
    if (hasFault(kFaultApronEmpty)) seen = kNoSurface;
    FloatRef(cube.list.faces[push.face].inv_z[layer]).at[indexAt(pixel)] = seen;
    nearest = max(nearest, seen);
  }
  // Rays begin in front of everything that a structure holds.
  MeasuredRef measured = MeasuredRef(cube.list.faces[push.face].measured);
  if (nearest > 0.0) {
    atomicMax(measured.value.head.inv_z_max_bits, floatBitsToUint(nearest));
  }
}
