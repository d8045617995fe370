// SPDX-License-Identifier: Apache-2.0
// The mean of each sample's colour along one axis, over the samples that links lead to on both
// sides (shaders/color.md, Means).
//
// An invocation takes a strip of px along the axis, one after the other, and keeps the samples
// around the one it is at: those of its own layer. The few px whose links lead to another layer are
// made anew in a second loop. Neighbouring invocations are side by side along x.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#include "lib/memory.glsl"
#include "shared/trace_abi.h"

layout(local_size_x = kTraceGroupSize) in;
layout(constant_id = kIdColorFormat) const uint kFormat = kColorRgba8;  // of what is read
layout(constant_id = kIdIsAlongY) const bool kIsAlongY = false;
layout(constant_id = kIdTapCount) const int kTapCount = 1;  // to each side
layout(constant_id = kIdStripPx) const int kStrip_px = 1;  // a power of two, at most 32
layout(push_constant, scalar) uniform Push { AveragePush push; };

layout(set = 0, binding = kBindingMeans, scalar) writeonly buffer Means {
  uint means[];
};

#include "lib/light/color.glsl"
#include "lib/structure/node.glsl"

const int kWindowPx = 2 * kTapCount + 1;
const uint kLowEdge = kIsAlongY ? kEdgeTop : kEdgeLeft;

// A row of the image, or a column.
struct Line {
  Extent extent;
  int across;
};

struct Sample {
  vec3 color;  // codes of sRGB
  uint links;
};

struct Sum {
  vec3 color;
  float weight;
};

ivec2 cellAt(Line line, int at) {
  return kIsAlongY ? ivec2(line.across, at) : ivec2(at, line.across);
}

int lengthOf(Line line) {
  return kIsAlongY ? line.extent.size_px.y : line.extent.size_px.x;
}

// Beyond the image, where no link leads, the last one.
Sample loadSample(Line line, uint layer, int at) {
  const ivec2 size_px = line.extent.size_px;
  const ivec2 cell = cellAt(line, clamp(at, 0, lengthOf(line) - 1));
  const uint index = uint(cell.y * size_px.x + cell.x);
  const vec3 texel = loadTexel(push.from, layer, uint(size_px.x * size_px.y), kFormat, index).rgb;
  return Sample(holdsCodes(kFormat) ? texel : codesFromRoots(texel),
                loadLinks(push.layers, layer, line.extent, cell));
}

// Samples that may be mixed count nothing.
void addTap(Sample tap_sample, int tap, bool is_linked, inout Sum sum) {
  const float weight = tap < kTapCount ? 1.0 : push.last_weight;
  const float share = is_linked && !isMixed(tap_sample.links) ? weight : 0.0;
  sum.color += share * tap_sample.color;
  sum.weight += share;
}

// Adds up around the sample in the middle, as far as links lead within its layer. False: one leads
// further.
bool sumInLayer(Sample window[kWindowPx], uint layer, out Sum sum) {
  sum = Sum(window[kTapCount].color, 1.0);
  bool is_whole = true;
  for (int side = 0; side < 2; ++side) {
    const int step = 2 * side - 1;
    bool goes_on = true;
    for (int tap = 1; tap <= kTapCount; ++tap) {
      const uint links = window[kTapCount + step * (tap - 1)].links;
      const uint link = linkOfEdge(links, kLowEdge + uint(side));
      is_whole = is_whole && !(goes_on && link > 0u && link != layer + 1u);
      goes_on = goes_on && link == layer + 1u;
      addTap(window[kTapCount + step * tap], tap, goes_on, sum);
    }
  }
  return is_whole;
}

// Through all layers.
Sum sumAlongLinks(Line line, uint own_layer, int at) {
  const Sample own = loadSample(line, own_layer, at);
  Sum sum = Sum(own.color, 1.0);
  for (int side = 0; side < 2; ++side) {
    const int step = 2 * side - 1;
    uint layer = own_layer;
    uint links = own.links;
    bool goes_on = true;
    for (int tap = 1; tap <= kTapCount; ++tap) {
      const uint link = linkOfEdge(links, kLowEdge + uint(side));
      goes_on = goes_on && link > 0u;
      layer = goes_on ? link - 1u : layer;
      const Sample tap_sample = loadSample(line, layer, at + step * tap);
      links = tap_sample.links;
      addTap(tap_sample, tap, goes_on, sum);
    }
  }
  return sum;
}

void storeMean(Line line, uint layer, int at, Sum sum) {
  const uint texel = rgb11OfCodes(sum.color * (1.0 / sum.weight));
  const ivec2 size_px = line.extent.size_px;
  const ivec2 cell = cellAt(line, at);
  const uint index = uint(cell.y * size_px.x + cell.x);
  if (kWriteByAddress)
    UintRef(pickAddress(push.to, layer)).at[index] = texel;
  else
    means[layer * uint(size_px.x * size_px.y) + index] = texel;
}

// Whether the block that the strip lies in has no surface in a layer.
bool isEmpty(Line line, uint layer, int first) {
  uint level = kLevelFirst;
  for (int side_px = kBlockPx; side_px < kStrip_px; side_px *= 2) ++level;
  const uvec2 block = uvec2(cellAt(line, first)) >> level;
  const uvec2 node = loadCell(push.layers, layer, line.extent, level, block);
  return !isPlane(node) && uintBitsToFloat(node.y) < 0.0;
}

void main() {
  const uint layer = gl_WorkGroupID.x;
  const int x = int(gl_WorkGroupID.y * kTraceGroupSize + gl_LocalInvocationID.x);
  const int y = int(push.first_strip + gl_WorkGroupID.z);
  const Extent extent = makeExtent(ivec2(push.size_px & 0xffffu, push.size_px >> 16));
  const Line line = Line(extent, kIsAlongY ? x : y);
  const int first = (kIsAlongY ? y : x) * kStrip_px;
  if (x * (kIsAlongY ? 1 : kStrip_px) >= extent.size_px.x) return;

  // Only of the first layer colour is shown where there is no surface: at the image's border.
  const bool is_deeper = layer > 0u;
  const int end =
      is_deeper && isEmpty(line, layer, first) ? first : min(first + kStrip_px, lengthOf(line));
  Sample window[kWindowPx];
  for (int i = 1; i < kWindowPx; ++i) {
    window[i] = loadSample(line, layer, first + i - 1 - kTapCount);
  }
  uint linked_further = 0u;  // a bit each
  int at = first;
  do {
    for (int i = 1; i < kWindowPx; ++i) window[i - 1] = window[i];
    window[kWindowPx - 1] = loadSample(line, layer, at + kTapCount);
    Sum sum;
    const bool is_whole = sumInLayer(window, layer, sum);
    const bool is_shown = !is_deeper || (window[kTapCount].links & kFacetExists) != 0u;
    if (is_whole && is_shown) storeMean(line, layer, at, sum);
    linked_further |= is_whole ? 0u : 1u << uint(at - first);
    ++at;
  } while (at < end);
  do {
    if (linked_further != 0u) {
      const int further = first + findLSB(linked_further);
      storeMean(line, layer, further, sumAlongLinks(line, layer, further));
    }
    linked_further &= linked_further - 1u;
  } while (linked_further != 0u);
}
