// SPDX-License-Identifier: Apache-2.0
// Where a walk enters a cell of 4x4 px: its largest planar ancestor, else its own node.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#include "lib/structure/node.glsl"
#include "lib/structure/structure_access.glsl"

layout(local_size_x = kNodeGroupSize) in;
layout(push_constant, scalar) uniform Push { BuildPush push; };

// A pass may be cut into dispatches of some rows of groups each.
uint groupRow() { return push.first_group_row + gl_WorkGroupID.y; }

void main() {
  const uint layer = gl_WorkGroupID.z;
  const Extent extent = makeExtent(ivec2(push.width_px, push.height_px));
  const uvec2 cell = uvec2(gl_GlobalInvocationID.x, groupRow());
  if (int(cell.x << kLevelFirst) >= extent.size_px.x) return;
  uvec2 entry = loadCell(push.layers, layer, extent, kLevelFirst, cell);
  // An ancestor is planar only if all below it are.
  for (uint level = kLevelFirst + 1u; level <= kLevelLast && isPlane(entry); ++level) {
    const uvec2 ancestor =
        loadCell(push.layers, layer, extent, level, cell >> (level - kLevelFirst));
    if (!isPlane(ancestor)) break;
    entry = ancestor;
  }
  storeCell(push.layers, layer, extent, kLevelEntries, cell, entry);
}
