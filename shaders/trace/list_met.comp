// SPDX-License-Identifier: Apache-2.0
// The sheets that a round of walked rays of each block of 8x8 px met (shaders/lens.md),
// in the order in which they are found, after those of the rounds before: an invocation a block.
// Blocks that are not complete are listed. What lies outside the band is not looked at.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#include "lib/memory.glsl"
#include "shared/lens_abi.h"
#include "shared/sheet_reach.h"
#include "shared/trace_abi.h"

layout(local_size_x = kTraceGroupSize) in;
layout(push_constant, scalar) uniform Push {
  GatherPush push;
};
layout(set = 0, binding = kBindingMet, scalar) readonly buffer Met {
  uint met[];
};
layout(set = 0, binding = kBindingMetLists, scalar) buffer MetLists {
  MetList lists[];
};
layout(set = 0, binding = kBindingIncomplete, scalar) buffer Incomplete {
  IncompleteHead incomplete;
  uint incomplete_blocks[];
};

#include "lib/rays/met_blocks.glsl"
#include "lib/rays/views.glsl"
#include "lib/walk/met_surface.glsl"

// A new sheet: the surface itself where it is a node. A facet alone leans as its neighbours have
// it, so the node around it counts, if that is a plane; else it is taken to face the source.
MetSheet sheetOf(MetSurface surface, vec3 plane, Extent extent, float inv_z, float reach) {
  const uvec2 around = uvec2(surface.cell) >> kLevelFirst;
  const uvec2 bits = loadCell(push.layers, surface.layer, extent, kLevelFirst, around);
  if (surface.level != kLevelFacets) return MetSheet(plane, surface.layer, reach);
  const vec2 slope = isPlane(bits) ? unpackSlopes(bits.y) : vec2(0.0);
  const vec3 around_it = vec3(slope, inv_z - dot(slope, vec2(surface.cell) + 0.5));
  return MetSheet(around_it, surface.layer, reach);
}

bool isOf(MetSheet sheet, uint layer, vec3 at, float inv_z) {
  return sheet.layer == layer && abs(dot(sheet.plane, at) - inv_z) <= sheet.reach;
}

void listIncomplete(uint list) {
  const uint place = atomicAdd(incomplete.count, 1u);
  incomplete_blocks[place] = list;
  const uint kBlocksPerGroup = kTraceGroupSize / kMetBlockSide_px;
  if (place % kBlocksPerGroup == 0u) atomicAdd(incomplete.group_count.x, 1u);
}

// Ends a round: the sheets of a block so far, and whether they are all. Gathered rays that meet
// nothing count as walked ones where rays are assumed to see something, so those blocks never have
// enough.
void endRound(uint list, uint count_before, uint kinds_before, uint sheet_count, uint kinds,
              bool is_empty) {
  const uint count = sheet_count > kMetSheetMax ? kMetTooMany : sheet_count;
  const bool is_first = push.first_sample == 0u;
  const bool is_one = kinds == 0u ? count == 1u : kinds == kMetSeesBackground && count == 0u;
  const bool is_known = count == count_before && kinds == kinds_before && count != kMetTooMany &&
                        (kinds & kMetSeesAssumed) == 0u;
  const bool is_complete = is_empty || (is_first ? is_one : is_known);
  lists[list].walked_count = push.end_sample;
  lists[list].count = count;
  lists[list].kinds =
      kinds | (is_first && is_one ? kMetSettled : 0u) | (is_complete ? kMetComplete : 0u);
  if (!is_complete) listIncomplete(list);
}

void main() {
  const uvec2 at_block = uvec2(gl_GlobalInvocationID.x, gl_WorkGroupID.y);
  const BlockGrid grid = gridOf(push);
  if (at_block.x >= blocksPerRow(grid)) return;
  if (at_block == uvec2(0u)) incomplete.group_count.yz = uvec2(1u);
  const uint list = at_block.y * blocksPerRow(grid) + at_block.x;
  const bool is_first = push.first_sample == 0u;
  const uint count_before = is_first ? 0u : lists[list].count;
  const uint kinds_before = is_first ? 0u : lists[list].kinds;
  if ((kinds_before & kMetComplete) != 0u) return;
  uint count = count_before;
  uint kinds = kinds_before;
  const MetBlock block = metBlock(grid, at_block);
  const uvec2 tile = tileOfBlock(grid, at_block);
  const ViewParams view = views[tile.y * grid.tile_count.x + tile.x];
  const Extent extent = makeExtent(ivec2(sizeOf(push.source_size_px)));
  const vec2 middle = vec2(firstInTile(grid, at_block)) + 0.5 * float(kMetBlockSide_px);
  const float direction_z = view.direction.z + middle.x * view.direction_dx.z +
                            middle.y * view.direction_dy.z;
  MetSheet last = MetSheet(vec3(0.0), kLayerCountMax, 0.0);
  const uint width = block.end_x - block.first_x;
  const uint px_count = width * (block.end_row - block.first_row);
  const bool is_empty = view.is_used == 0u || px_count == 0u;
  const bool is_idle = is_empty || count == kMetTooMany;
  const uint name_count = is_idle ? 0u : px_count * (push.end_sample - push.first_sample);
  for (uint i = 0u; i < name_count; ++i) {
    const uint sample_index = i / px_count;
    const uint in_block = i - sample_index * px_count;
    const uint y = block.first_row + in_block / width;
    const uint x = block.first_x + in_block % width;
    const uint name =
        met[((push.first_sample + sample_index) * push.row_count + y) * push.atlas_width_px + x];
    const bool is_met = name != kMetBackground && name != kMetAssumed;
    kinds |= name == kMetBackground ? kMetSeesBackground : 0u;
    kinds |= name == kMetAssumed ? kMetSeesAssumed : 0u;
    const MetSurface surface = metSurface(is_met ? name : 0u);
    const vec3 plane = planeOf(surface, loadSurface(push.layers, extent, surface));
    const vec3 at = vec3(vec2(surface.cell) + 0.5, 1.0);
    const float inv_z = dot(plane, at);
    bool is_new = is_met && !isOf(last, surface.layer, at, inv_z);
    // A loop is what a software device passes over where nobody needs it.
    for (uint k = 0u; is_new && k < min(count, kMetSheetMax); ++k) {
      const MetSheet sheet = lists[list].sheets[k];
      is_new = !isOf(sheet, surface.layer, at, inv_z);
      if (!is_new) last = sheet;
    }
    for (; is_new; is_new = false) {
      const SheetReach reach = sheetReach(view, at.xy, direction_z);
      last = sheetOf(surface, plane, extent, inv_z, leastReach(reach, inv_z, inv_z));
      if (count < kMetSheetMax) lists[list].sheets[count] = last;
      ++count;
    }
  }
  endRound(list, count_before, kinds_before, min(count, kMetSheetMax + 1u), kinds, is_empty);
}
