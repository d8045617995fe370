// SPDX-License-Identifier: Apache-2.0
// One pass over inv_z that is so coarse that it shows: samples approach the plane through their
// neighbours, within what they may be off (shaders/structure.md, Coarse depth). A block of 4x4 px
// an invocation.
//
// Passes read what the one before has left and write elsewhere: to two halves of where facets will
// be, in turn; the last one back to inv_z. Until then, inv_z holds the samples.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#include "lib/fault.glsl"
#include "lib/structure/structure_access.glsl"

layout(local_size_x = kNodeGroupSize) in;
layout(push_constant, scalar) uniform Push {
  BuildPush push;
};

#include "lib/structure/columns.glsl"
#include "lib/structure/layer_count.glsl"

float loadSample(uint layer, int x, int y) {
  const uint area = invZArea(push.width_px, push.height_px);
  return loadInvZ(push.inv_z, layer, area, invZIndex(invZPitch(push.width_px), uint(x), y));
}

// Words before a half: of one px each.
uint halfOffset(Extent extent, uint which) {
  return 2u * levelOffset(kLevelFacets, extent.padded_area) + which * extent.padded_area;
}

float loadHalf(Extent extent, uint layer, uint which, ivec2 pixel) {
  const uint index =
      halfOffset(extent, which) + uint(pixel.y) * extent.padded_width + uint(pixel.x);
  const uint word =
      kReadByAddress
          ? UintRef(pickAddress(push.layers, layer)).at[index]
          : texelFetch(structure_halves, int(2u * layer * extent.layer_words + index)).x;
  return uintBitsToFloat(word);
}

void storeHalf(Extent extent, uint layer, ivec2 pixel, vec4 inv_z) {
  const uint index = (halfOffset(extent, push.level & 1u) +
                      uint(pixel.y) * extent.padded_width + uint(pixel.x)) / 2u;
  storeWord(push.layers, layer, extent, index, floatBitsToUint(inv_z.xy));
  storeWord(push.layers, layer, extent, index + 1u, floatBitsToUint(inv_z.zw));
}

// 1/Z after the pass before; kNoSurface outside the image.
float loadAt(Extent extent, uint layer, ivec2 pixel) {
  const ivec2 inside = clamp(pixel, ivec2(0), extent.size_px - 1);
  if (inside != pixel) return kNoSurface;
  return push.level == measured_head.first_smoothing_pass
             ? loadSample(layer, pixel.x, pixel.y)
             : loadHalf(extent, layer, (push.level + 1u) & 1u, pixel);
}

Columns loadColumns(Extent extent, ivec2 pixel) {
  Columns columns;
  for (uint i = 0u; i < kLayerCount; ++i) {
    for (int k = 0; k < 4; ++k) columns.inv_z[i][k] = loadAt(extent, i, pixel + ivec2(k, 0));
  }
  return columns;
}

// On both sides of a px of each column.
struct Pair {
  Columns before;
  Columns after;
};

Pair loadPair(Extent extent, ivec2 pixel, ivec2 along) {
  return Pair(loadColumns(extent, pixel - along), loadColumns(extent, pixel + along));
}

// How far the mean of the neighbours on both sides lies from inv_z; less where that is no longer
// what one surface could do, down to 0.
vec4 bendAt(Pair pair, vec4 inv_z) {
  const vec4 a = nearestIn(pair.before, inv_z);
  const vec4 b = nearestIn(pair.after, inv_z);
  const vec4 bend = 0.5 * ((a - inv_z) + (b - inv_z));
  const vec4 limit = vec4(kPairReaches * measured_head.smoothing_reach);
  const vec4 most = max(limit - max(abs(bend), abs(b - a)), vec4(0.0));
  return mix(vec4(0.0), clamp(bend, -most, most), greaterThan(min(a, b), vec4(0.0)));
}

struct Pairs {
  Pair across;
  Pair down;
  Pair falling;
  Pair rising;
};

Pairs loadPairs(Extent extent, ivec2 pixel) {
  const int stride = smoothingStride(push.level);
  return Pairs(loadPair(extent, pixel, ivec2(stride, 0)), loadPair(extent, pixel, ivec2(0, stride)),
               loadPair(extent, pixel, ivec2(stride, stride)),
               loadPair(extent, pixel, ivec2(stride, -stride)));
}

// `before` and `behind`: samples of the layers beside it.
void smoothLayer(Extent extent, uint layer, ivec2 pixel, Pairs pairs, vec4 inv_z, vec4 samples,
                 vec4 before, vec4 behind) {
  const vec4 sum = bendAt(pairs.across, inv_z) + bendAt(pairs.down, inv_z) +
                   bendAt(pairs.falling, inv_z) + bendAt(pairs.rising, inv_z);
  // Layers keep their order.
  const float share = hasFault(kFaultGapPassed) ? 8.0 : kSmoothingGapShare;
  const vec4 reach = vec4(measured_head.smoothing_reach);
  const vec4 low = samples - min(reach, share * (samples - max(behind, vec4(0.0))));
  const vec4 high = samples + min(reach, share * (before - samples));
  // Neither the sky nor what is no surface is rounded.
  const vec4 result = mix(samples, clamp(inv_z + kSmoothingShare * sum, low, high),
                          greaterThan(samples, vec4(0.0)));
  if (push.level + 1u < kSmoothingPassCount)
    storeHalf(extent, layer, pixel, result);
  else
    storeInvZ(push.inv_z[layer], layer, invZArea(push.width_px, push.height_px),
              invZIndex(invZPitch(push.width_px), uint(pixel.x), pixel.y), result);
}

// Layers stand one by one: see lib/structure/links.glsl.
void smoothRow(Extent extent, ivec2 pixel) {
  const vec4 nearest = vec4(3.4e38);
  const vec4 farthest = vec4(kNoSurface);
  Columns samples;
  for (uint i = 0u; i < kLayerCount; ++i) {
    for (int k = 0; k < 4; ++k) samples.inv_z[i][k] = loadSample(i, pixel.x + k, pixel.y);
  }
  const Columns now = loadColumns(extent, pixel);
  const Pairs pairs = loadPairs(extent, pixel);
  smoothLayer(extent, 0u, pixel, pairs, now.inv_z[0], samples.inv_z[0], nearest,
              kLayerCount > 1u ? samples.inv_z[1] : farthest);
  if (kLayerCount > 1u) {
    smoothLayer(extent, 1u, pixel, pairs, now.inv_z[1], samples.inv_z[1], samples.inv_z[0],
                kLayerCount > 2u ? samples.inv_z[2] : farthest);
  }
  if (kLayerCount > 2u) {
    smoothLayer(extent, 2u, pixel, pairs, now.inv_z[2], samples.inv_z[2], samples.inv_z[1],
                kLayerCount > 3u ? samples.inv_z[3] : farthest);
  }
  if (kLayerCount > 3u) {
    smoothLayer(extent, 3u, pixel, pairs, now.inv_z[3], samples.inv_z[3], samples.inv_z[2],
                farthest);
  }
}

void main() {
  const ivec2 origin = ivec2(gl_GlobalInvocationID.x, gl_WorkGroupID.y) * kBlockPx;
  if (origin.x >= int(push.width_px)) return;
  const Extent extent = makeExtent(ivec2(push.width_px, push.height_px));
  int row = 0;
  do {
    smoothRow(extent, origin + ivec2(0, row));
    ++row;
  } while (row < kBlockPx);
}
