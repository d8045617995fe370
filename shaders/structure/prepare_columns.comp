// SPDX-License-Identifier: Apache-2.0
// Depth samples of all layers to columns of inv_z in canonical form: nearest first, no duplicates,
// no gaps. Bad samples are no surface; they and the columns that came unsorted are counted.
//
// An invocation takes a block of 4x4 px, a row of four at a time: what every invocation costs on a
// software device is then shared by 16 px. Blocks around the image write the guard of no surface.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#include "lib/memory.glsl"
#include "lib/structure/layer_count.glsl"

layout(local_size_x = kNodeGroupSize) in;
layout(constant_id = kIdSampleType) const uint kSampleType = kDepthSampleF32;
layout(constant_id = kIdHasRayDistance) const bool kHasRayDistance = false;
layout(push_constant, scalar) uniform Push {
  BuildPush push;
};

// A pass may be cut into dispatches of some rows of groups each.
uint groupRow() { return push.first_group_row + gl_WorkGroupID.y; }

layout(set = 0, binding = kBindingSamples) uniform usamplerBuffer sample_words;
layout(set = 0, binding = kBindingDepthPlanes, scalar) uniform Planes {
  DepthPlanes depth;
};

float sampleOfBits(uint type, uint word, uint index) {
  const uint half_word = (word >> ((index & 1u) * 16u)) & 0xffffu;
  if (type == kDepthSampleF32) return uintBitsToFloat(word);
  return type == kDepthSampleF16 ? unpackHalf2x16(half_word).x : float(half_word);
}

// `index`: of the sample in the upload, in samples of its size.
float loadSample(uint type, uint index) {
  const uint at = type == kDepthSampleF32 ? index : index / 2u;
  const uint word =
      kReadByAddress ? UintRef(depth.samples).at[at] : texelFetch(sample_words, int(at)).x;
  return sampleOfBits(type, word, index);
}

bvec4 both(bvec4 a, bvec4 b) {
  return mix(bvec4(false), a, b);
}

uint countOf(bvec4 flags) {
  const uvec4 ones = mix(uvec4(0u), uvec4(1u), flags);
  return ones.x + ones.y + ones.z + ones.w;
}

// inv_z, or kNoSurface; bad samples are counted (server/core/frame/depth.h, DepthCoefficients).
vec4 linearise(DepthPlane plane, vec4 depth_sample, vec4 ray_length, bvec4 exists,
               inout uint bad_count) {
  // Not fused: where the two terms cancel, as for window depth, the sweep would see other values.
  precise const vec4 value = (depth_sample - plane.origin) * vec4(plane.scale) + plane.offset;
  const bool is_reciprocal = plane.reciprocal != 0u;
  const vec4 length = plane.ray_distance != 0u ? ray_length : vec4(1.0);
  const vec4 inv_z = is_reciprocal ? (1.0 / value) * length : value;
  const bvec4 is_invalid =
      both(equal(depth_sample, vec4(plane.invalid_value)), bvec4(plane.has_invalid != 0u));
  const bvec4 is_nothing = both(equal(value, vec4(0.0)), bvec4(is_reciprocal));
  const bvec4 is_good =
      both(greaterThanEqual(value, vec4(0.0)), lessThanEqual(inv_z, vec4(plane.inv_z_max)));
  const vec4 invalid = vec4(plane.invalid_inv_z);
  const vec4 valid = mix(vec4(kNoSurface), inv_z, is_good);
  bad_count += countOf(both(both(exists, not(is_invalid)), both(not(is_nothing), not(is_good))));
  return mix(vec4(kNoSurface), mix(valid, invalid, is_invalid), exists);
}

// Exchanges two layers: no surface (-1) sinks to the end by itself.
void exchange(inout vec4 near, inout vec4 far) {
  const vec4 nearer = max(near, far);
  far = min(near, far);
  near = nearer;
}

// Columns as they are kept: `count` surfaces so far, the last at `last`.
struct Kept {
  vec4 inv_z[kLayerCountMax];
  uvec4 count;
  vec4 last;
};

// Adds what is more than one sample's worth behind the last surface.
void keep(inout Kept kept, vec4 inv_z) {
  precise const vec4 format_step =
      push.format_step.x + inv_z * (push.format_step.y + inv_z * push.format_step.z);
  const bvec4 stays =
      both(greaterThanEqual(inv_z, vec4(0.0)), greaterThan(kept.last - inv_z, format_step));
  for (uint i = 0u; i < kLayerCount; ++i) {
    const bvec4 is_here = both(stays, equal(kept.count, uvec4(i)));
    kept.inv_z[i] = mix(kept.inv_z[i], inv_z, is_here);
  }
  kept.count += mix(uvec4(0u), uvec4(1u), stays);
  kept.last = mix(kept.last, inv_z, stays);
}

// Four columns, side by side. Layers stand one by one: see lib/structure/links.glsl.
void sortColumns(inout vec4 column[kLayerCountMax], inout uint unsorted_count) {
  // A surface behind a gap counts as in order; one in front of an earlier surface does not.
  bvec4 is_unsorted = bvec4(false);
  vec4 farthest = vec4(3.4e38);
  for (uint i = 0u; i < kLayerCount; ++i) {
    is_unsorted = mix(is_unsorted, bvec4(true), greaterThan(column[i], farthest));
    farthest = mix(farthest, column[i], greaterThanEqual(column[i], vec4(0.0)));
  }
  unsorted_count += countOf(is_unsorted);

  exchange(column[0], column[1]);
  if (kLayerCount > 3u) exchange(column[2], column[3]);
  if (kLayerCount > 2u) exchange(column[1], column[2]);
  if (kLayerCount > 2u) exchange(column[0], column[1]);
  if (kLayerCount > 3u) exchange(column[2], column[3]);
  if (kLayerCount > 3u) exchange(column[1], column[2]);

  Kept kept;
  kept.count = uvec4(0u);
  kept.last = vec4(3.4e38);
  for (uint i = 0u; i < kLayerCount; ++i) kept.inv_z[i] = vec4(kNoSurface);
  keep(kept, column[0]);
  keep(kept, column[1]);
  if (kLayerCount > 2u) keep(kept, column[2]);
  if (kLayerCount > 3u) keep(kept, column[3]);
  column = kept.inv_z;
}

// Layer `layer` of four px of a row: samples from `index` on.
vec4 loadLayer(uint layer, uvec4 index, vec4 ray_length, bvec4 exists, inout uint bad_count) {
  const DepthPlane plane = depth.planes[layer];
  const uint type = kSampleType == kDepthSampleMixed ? plane.sample_type : kSampleType;
  const uvec4 at = plane.first_sample + index;
  const vec4 samples = vec4(loadSample(type, at.x), loadSample(type, at.y), loadSample(type, at.z),
                            loadSample(type, at.w));
  return linearise(plane, samples, ray_length, exists, bad_count);
}

void main() {
  const ivec2 size = ivec2(push.width_px, push.height_px);
  const uint pitch = invZPitch(push.width_px);
  const uint area = invZArea(push.width_px, push.height_px);
  const int x = int(gl_GlobalInvocationID.x) * kBlockPx;
  if (x >= int(pitch)) return;
  const ivec4 xs = x + ivec4(0, 1, 2, 3);
  // Size of the uploaded part; the apron around a face of a cube map is filled later.
  const int apron = int(push.apron_px);
  const ivec2 given = size - 2 * apron;
  const ivec4 given_xs = xs - apron;
  const uvec4 clamped_xs = uvec4(clamp(given_xs, ivec4(0), ivec4(given.x - 1)));
  const vec4 ray_x = (vec4(xs) + 0.5 - depth.principal_px.x) / depth.focal_px.x;
  uint bad_count = 0u;
  uint unsorted_count = 0u;
  int row = 0;
  do {
    const int y = (int(groupRow()) - 1) * kBlockPx + row;
    const int given_y = y - apron;
    const bvec4 exists = both(both(lessThan(given_xs, ivec4(given.x)),
                                   greaterThanEqual(given_xs, ivec4(0))),
                              bvec4(given_y >= 0 && given_y < given.y));
    const uvec4 index = uint(clamp(given_y, 0, given.y - 1) * given.x) + clamped_xs;
    const float ray_y = (float(y) + 0.5 - depth.principal_px.y) / depth.focal_px.y;
    const vec4 ray_length =
        kHasRayDistance ? sqrt(ray_x * ray_x + (ray_y * ray_y + 1.0)) : vec4(1.0);
    vec4 column[kLayerCountMax];
    column[0] = loadLayer(0u, index, ray_length, exists, bad_count);
    if (kLayerCount > 1u) column[1] = loadLayer(1u, index, ray_length, exists, bad_count);
    if (kLayerCount > 2u) column[2] = loadLayer(2u, index, ray_length, exists, bad_count);
    if (kLayerCount > 3u) column[3] = loadLayer(3u, index, ray_length, exists, bad_count);
    if (kLayerCount > 1u) sortColumns(column, unsorted_count);
    const uint at = invZIndex(pitch, uint(x), y);
    for (uint i = 0u; i < kLayerCount; ++i) storeInvZ(push.inv_z[i], i, area, at, column[i]);
    ++row;
  } while (row < kBlockPx);
  MeasuredRef measured = MeasuredRef(push.measured);
  if (bad_count > 0u) atomicAdd(measured.value.head.bad_samples_count, bad_count);
  if (unsorted_count > 0u) atomicAdd(measured.value.head.unsorted_columns_count, unsorted_count);
}
