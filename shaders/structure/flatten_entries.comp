// SPDX-License-Identifier: Apache-2.0
// Where a walk enters a cell of 4x4 px: its largest planar ancestor, else its own node.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#include "lib/node.glsl"
#include "lib/structure_access.glsl"

layout(local_size_x = kNodeGroupSize) in;
layout(push_constant, scalar) uniform Push { BuildPush push; };

void main() {
  StructureRef structure = StructureRef(push.structure);
  const uint layer = gl_WorkGroupID.z;
  const uvec2 cell = uvec2(gl_GlobalInvocationID.x, gl_WorkGroupID.y);
  if (cell.x >= structure.value.level_width[0]) return;
  uvec2 entry = loadNode(structure, layer, kLevelFirst, cell);
  // An ancestor is planar only if all below it are.
  for (uint level = kLevelFirst + 1u; level <= kLevelLast && isPlane(entry); ++level) {
    const uvec2 ancestor = loadNode(structure, layer, level, cell >> (level - kLevelFirst));
    if (!isPlane(ancestor)) break;
    entry = ancestor;
  }
  const uint index = cell.y * structure.value.level_width[0] + cell.x;
  Uvec2Ref(structure.value.entries[layer]).at[index] = entry;
}
