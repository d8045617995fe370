// SPDX-License-Identifier: Apache-2.0
// The lowest level of the pyramid: a node for every 4x4 facets.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#include "lib/fault.glsl"
#include "lib/node.glsl"
#include "lib/plane_fit.glsl"
#include "lib/structure_access.glsl"

layout(local_size_x = kNodeGroupSize) in;
layout(push_constant, scalar) uniform Push {
  BuildPush push;
};

const int kBlockSize = 4;

// The facets of this invocation's block: kBlockSize rows.
float inv_z[kBlockSize * kBlockSize];
uint slopes[kBlockSize * kBlockSize];

// The nearest inv_z of what the column's links lead to before this layer, from this layer or a
// deeper one.
float nearestForward(Extent extent, uint layer, ivec2 pixel) {
  const ivec2 steps[4] = ivec2[4](ivec2(-1, 0), ivec2(1, 0), ivec2(0, -1), ivec2(0, 1));
  float nearest = kNoSurface;
  for (uint from = layer; from < push.layer_count; ++from) {
    const uint links = loadLinks(push.layers, from, extent, pixel);
    for (uint edge = 0u; edge < 4u; ++edge) {
      const uint link = linkOfEdge(links, edge);
      if (link == 0u || link - 1u >= layer) continue;
      const uvec2 facet = loadFacet(push.layers, link - 1u, extent, pixel + steps[edge]);
      nearest = max(nearest, facetBox(facetInvZ(facet), unpackSlopes(facet.y)).y);
    }
  }
  return nearest;
}

// The plane that fits the block, where its error is within half the connection tolerance; else the
// box. inv_z_min: of the block's facets.
uvec2 planeOrBox(PlaneFit fit, vec2 box, float inv_z_min, ivec2 covered) {
  const vec2 fitted = fittedSlope(fit);
  const float fitted_center = fittedCenter(fit, fitted);
  // The error is that of the plane as stored.
  const float center = planeCenter(packPlane(kLevelFirst, max(fitted_center, 0.0), fitted, 0u));
  const vec2 slope = unpackSlopes(packSlopes(fitted));
  float error = 0.0;
  for (int y = 0; y < kBlockSize; ++y) {
    for (int x = 0; x < kBlockSize; ++x) {
      if (x >= covered.x || y >= covered.y) continue;
      const vec2 position = vec2(x, y) + 0.5 - 0.5 * float(kBlockSize);
      const vec2 lean = abs(unpackSlopes(slopes[y * kBlockSize + x]) - slope);
      const float apart = abs(inv_z[y * kBlockSize + x] - (center + dot(slope, position)));
      error = max(error, apart + 0.5 * (lean.x + lean.y));
    }
  }
  // A few roundings of the sums above, of numbers no larger than the box.
  error += box.y * (8.0 / 8388608.0);
  if (hasFault(kFaultErrorUnderstated)) error *= 0.25;
  const uint code = errorCode(error);
  const float kappa =
      connectionTolerance(measured_head.kappa_abs, measured_head.kappa_rel, inv_z_min);
  if (fitted_center >= 0.0 && error <= kErrorMax && errorOfCode(code) <= 0.5 * kappa) {
    return packPlane(kLevelFirst, center, slope, code);
  }
  return packBox(kLevelFirst, box);
}

void main() {
  const uint layer = gl_WorkGroupID.z;
  const Extent extent = makeExtent(ivec2(push.width_px, push.height_px));
  const uvec2 cell = uvec2(gl_GlobalInvocationID.x, gl_WorkGroupID.y);
  const ivec2 origin = ivec2(cell) * kBlockSize;
  if (origin.x >= extent.size_px.x) return;
  const ivec2 covered = min(extent.size_px - origin, ivec2(kBlockSize));

  PlaneFit fit = startFit();
  vec2 box = vec2(3.4e38, kNoSurface);
  float inv_z_min = 3.4e38;
  bool has_hole = false;
  uint forward_links = 0u;  // facets that have one, a bit each
  for (int y = 0; y < kBlockSize; ++y) {
    for (int x = 0; x < kBlockSize; ++x) {
      if (x >= covered.x || y >= covered.y) continue;
      const uvec2 facet = loadFacet(push.layers, layer, extent, origin + ivec2(x, y));
      const float center = facetInvZ(facet);
      inv_z[y * kBlockSize + x] = center;
      slopes[y * kBlockSize + x] = facet.y;
      if (center < 0.0) {
        has_hole = !hasFault(kFaultHoleIsSurface);
        continue;
      }
      const vec2 slope = unpackSlopes(facet.y);
      const vec2 facet_box = facetBox(center, slope);
      forward_links |= (facet.x & kForwardLinkFlag) != 0u ? 1u << uint(y * kBlockSize + x) : 0u;
      box = vec2(min(box.x, facet_box.x), max(box.y, facet_box.y));
      inv_z_min = min(inv_z_min, facet_box.x);
      addSample(fit, vec2(x, y) + 0.5 - 0.5 * float(kBlockSize), center, slope);
    }
  }
  if (has_hole) box.x = 0.0;
  if (hasFault(kFaultBoxTooSmall)) box.y = uintBitsToFloat(floatBitsToUint(box.y) - 4u);
  const bool has_forward_link = forward_links != 0u;
  // A walk of this layer must look at such edges: the surface goes on in front of it. A loop of its
  // own, since few blocks have any.
  while (forward_links != 0u) {
    const int i = findLSB(forward_links);
    forward_links &= forward_links - 1u;
    box.y =
        max(box.y, nearestForward(extent, layer, origin + ivec2(i % kBlockSize, i / kBlockSize)));
  }

  const bool may_be_plane = !has_hole && !has_forward_link;
  const uvec2 node =
      may_be_plane ? planeOrBox(fit, box, inv_z_min, covered) : packBox(kLevelFirst, box);
  storeCell(push.layers, layer, extent, kLevelFirst, cell, node);
}
