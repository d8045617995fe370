// SPDX-License-Identifier: Apache-2.0
// A level of the pyramid from the one below it: planes where four planes fit one, boxes elsewhere.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#include "lib/fault.glsl"
#include "lib/structure/node.glsl"
#include "lib/structure/plane_fit.glsl"
#include "lib/structure/structure_access.glsl"

layout(local_size_x = kNodeGroupSize) in;
layout(push_constant, scalar) uniform Push {
  BuildPush push;
};

// A pass may be cut into dispatches of some rows of groups each.
uint groupRow() { return push.first_group_row + gl_WorkGroupID.y; }

void main() {
  MeasuredRef measured = MeasuredRef(push.measured);
  const uint layer = gl_WorkGroupID.z;
  const Extent extent = makeExtent(ivec2(push.width_px, push.height_px));
  const uvec2 cell = uvec2(gl_GlobalInvocationID.x, groupRow());
  const int child_size_px = 1 << (push.level - 1u);
  const float child_size = float(child_size_px);
  if (int(cell.x) * 2 * child_size_px >= extent.size_px.x) return;

  Node children[4];
  bool exists[4];
  PlaneFit fit = startFit();
  vec2 box = vec2(3.4e38, kNoSurface);
  bool all_planes = true;
  for (uint i = 0u; i < 4u; ++i) {
    const uvec2 child_cell = 2u * cell + uvec2(i & 1u, i >> 1);
    exists[i] = all(lessThan(ivec2(child_cell) * child_size_px, extent.size_px));
    if (!exists[i]) continue;
    children[i] = unpackNode(loadCell(push.layers, layer, extent, push.level - 1u, child_cell));
    all_planes = all_planes && children[i].is_plane;
    const vec2 child_box = nodeBox(children[i]);
    if (!(hasFault(kFaultChildForgotten) && i == 3u)) {
      box = vec2(min(box.x, child_box.x), max(box.y, child_box.y));
    }
    const vec2 position = (vec2(i & 1u, i >> 1) - 0.5) * child_size;
    addSample(fit, position, children[i].inv_z, children[i].slope);
  }

  uvec2 node = packBox(push.level, box);
  if (all_planes) {
    const vec2 fitted = fittedSlope(fit);
    const float fitted_center = fittedCenter(fit, fitted);
    const float center = planeCenter(packPlane(push.level, max(fitted_center, 0.0), fitted, 0u));
    const vec2 slope = unpackSlopes(packSlopes(fitted));
    float error = 0.0;
    for (uint i = 0u; i < 4u; ++i) {
      if (!exists[i]) continue;
      const vec2 position = (vec2(i & 1u, i >> 1) - 0.5) * child_size;
      const vec2 lean = abs(children[i].slope - slope);
      const float apart = abs(children[i].inv_z - (center + dot(slope, position)));
      error = max(error, children[i].error + apart + 0.5 * child_size * (lean.x + lean.y));
    }
    error += box.y * (8.0 / 8388608.0);
    const uint code = errorCode(error);
    const float kappa =
        stepAt(connectedSteps(measured_head), box.x);
    if (fitted_center >= 0.0 && error <= kErrorMax && errorOfCode(code) <= 0.5 * kappa) {
      node = packPlane(push.level, center, slope, code);
    }
  }
  storeCell(push.layers, layer, extent, push.level, cell, node);

  if (push.level == kLevelLast && box.y >= 0.0) {
    // Layer 0 is the nearest of every column.
    if (layer == 0u) atomicMax(measured.value.head.inv_z_max_bits, floatBitsToUint(box.y));
    atomicMin(measured.value.head.inv_z_min_bits, floatBitsToUint(box.x));
  }
}
