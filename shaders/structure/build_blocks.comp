// SPDX-License-Identifier: Apache-2.0
// Links of every facet, and the lowest level of the pyramid: a node for every 4x4 facets, which an
// invocation takes with the facets around them.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#include "lib/fault.glsl"
#include "lib/memory.glsl"

layout(local_size_x = kNodeGroupSize) in;
layout(push_constant, scalar) uniform Push {
  BuildPush push;
};

// A pass may be cut into dispatches of some rows of groups each.
uint groupRow() { return push.first_group_row + gl_WorkGroupID.y; }

#include "lib/structure/facet_row.glsl"
#include "lib/structure/layer_count.glsl"
#include "lib/structure/links.glsl"
#include "lib/structure/node.glsl"
#include "lib/structure/plane_fit.glsl"

// Links of a row, and what they do to its facets.
struct RowLinks {
  uvec4 word[kLayerCountMax];
  vec4 forward_high[kLayerCountMax];
};

// Children of a node.
struct Block {
  PlaneFit fit;
  vec2 box;
  float forward;  // the nearest of what links lead forward to; kNoSurface
  bool has_hole;
  uint flagged;  // facets with a link forward, a bit each
};

void addLinks(inout RowLinks links, uint edge, EdgeLinks across) {
  for (uint i = 0u; i < kLayerCount; ++i) {
    links.word[i] |= across.link[i] << (edge * kLinkBits);
    links.forward_high[i] = max(links.forward_high[i], across.forward_high[i]);
  }
}

// Edges between the columns of a row, and those beside it.
void linkColumns(inout RowLinks links, FacetRow row, FacetRow left, FacetRow right, Steps steps) {
  const EdgeSide here = sideOf(row, vec2(0.5, 0.0));
  const EdgeSide own_left = sideOf(row, vec2(-0.5, 0.0));
  const EdgeSide beyond = sideOf(right, vec2(-0.5, 0.0));
  EdgeSide there;
  EdgeSide first;
  for (uint i = 0u; i < kLayerCount; ++i) {
    there.at[i] = vec4(own_left.at[i].yzw, beyond.at[i].x);
    there.facet_high[i] = vec4(own_left.facet_high[i].yzw, beyond.facet_high[i].x);
    first.at[i] = vec4(own_left.at[i].x, vec3(kNoSurface));
    first.facet_high[i] = vec4(own_left.facet_high[i].x, vec3(kNoSurface));
  }
  EdgeLinks to_right;
  EdgeLinks to_left;
  linkAcross(here, there, steps, to_right, to_left);
  EdgeLinks first_to_left;
  EdgeLinks unused;
  linkAcross(first, sideOf(left, vec2(0.5, 0.0)), steps, first_to_left, unused);
  for (uint i = 0u; i < kLayerCount; ++i) {
    to_left.link[i] = uvec4(first_to_left.link[i].x, to_left.link[i].xyz);
    to_left.forward_high[i] = vec4(first_to_left.forward_high[i].x, to_left.forward_high[i].xyz);
  }
  addLinks(links, kEdgeRight, to_right);
  addLinks(links, kEdgeLeft, to_left);
}

void storeLinkRow(Extent extent, uint layer, ivec2 pixel, uvec4 links, vec4 inv_z) {
  const uvec4 word = links | mix(uvec4(kFacetExists), uvec4(0u), lessThan(inv_z, vec4(0.0)));
  storeWord(push.layers, layer, extent, linkWordIndex(extent, pixel),
            uvec2(word.x | (word.y << 16), word.z | (word.w << 16)));
}

// Sets the flag of the facets that have a link forward. Few blocks have any: one store in a loop.
void flagForward(Extent extent, uint layer, ivec2 origin, uint flagged) {
  for (;;) {
    if (push.layer_count == kLayerCountMax + 1u) break;  // shaders/README.md, Loops
    const int k = findLSB(flagged);
    const ivec2 pixel = origin + ivec2(k & 3, k >> 2);
    if (flagged != 0u) {
      const uvec2 facet = loadFacet(push.layers, layer, extent, pixel);
      storeWord(push.layers, layer, extent, facetIndex(extent, pixel),
                uvec2(facet.x | kForwardLinkFlag, facet.y));
    }
    flagged &= flagged - 1u;
    if (flagged == 0u) break;
  }
}

// Positions of the columns or rows of a block from its centre.
const vec4 kPositions = vec4(-1.5, -0.5, 0.5, 1.5);

// The plane that fits the block, where its error is within half the connection tolerance; else the
// box. `columns`: 1 where the image goes on, over `row_count` rows; `inv_z_min`: of the block's
// facets.
uvec2 planeOrBox(Extent extent, uint layer, ivec2 origin, PlaneFit fit, vec2 box, float inv_z_min,
                 vec4 columns, int row_count) {
  const vec2 fitted = fittedSlope(fit);
  const float fitted_center = fittedCenter(fit, fitted);
  // The error is that of the plane as stored.
  const float center = planeCenter(packPlane(kLevelFirst, max(fitted_center, 0.0), fitted, 0u));
  const vec2 slope = unpackSlopes(packSlopes(fitted));
  vec4 apart_max = vec4(0.0);
  int row = 0;
  do {
    Facets facets;
    for (int k = 0; k < 4; ++k) {
      loadInto(facets, k, push.layers, extent, layer, origin + ivec2(k, row), true);
    }
    const vec4 plane = center + (slope.x * kPositions + slope.y * (float(row) - 1.5));
    const vec4 lean = abs(facets.slope_x - slope.x) + abs(facets.slope_y - slope.y);
    const vec4 apart = abs(facets.inv_z - plane) + 0.5 * lean;
    apart_max = max(apart_max, row < row_count ? apart * columns : vec4(0.0));
    ++row;
  } while (row < kBlockPx);
  float error = max(max(apart_max.x, apart_max.y), max(apart_max.z, apart_max.w));
  // A few roundings of the sums above, of numbers no larger than the box.
  error += box.y * (8.0 / 8388608.0);
  if (hasFault(kFaultErrorUnderstated)) error *= 0.25;
  const uint code = errorCode(error);
  const float kappa =
      stepAt(connectedSteps(measured_head), inv_z_min);
  if (fitted_center >= 0.0 && error <= kErrorMax && errorOfCode(code) <= 0.5 * kappa) {
    return packPlane(kLevelFirst, center, slope, code);
  }
  return packBox(kLevelFirst, box);
}

void addFacets(inout Block block, Facets facets, float y, vec4 columns) {
  const bvec4 in_image = greaterThan(columns, vec4(0.0));
  const bvec4 is_surface = both(in_image, greaterThanEqual(facets.inv_z, vec4(0.0)));
  block.has_hole = block.has_hole || is_surface != in_image;
  const vec4 low = mix(vec4(3.4e38), lowOf(facets), is_surface);
  const vec4 high = mix(vec4(kNoSurface), highOf(facets), is_surface);
  block.box.x = min(block.box.x, min(min(low.x, low.y), min(low.z, low.w)));
  block.box.y = max(block.box.y, max(max(high.x, high.y), max(high.z, high.w)));
  const vec4 inv_z = mix(vec4(0.0), facets.inv_z, is_surface);
  const float sum = dot(inv_z, columns);
  block.fit.inv_z += sum;
  block.fit.moment += vec2(dot(inv_z, columns * kPositions), sum * y);
  block.fit.slope += vec2(dot(facets.slope_x, columns), dot(facets.slope_y, columns));
}

// A row whose links are complete.
void finishRow(inout Block block, Extent extent, uint layer, ivec2 pixel, int row, uvec4 word,
               vec4 forward_high, vec4 inv_z) {
  storeLinkRow(extent, layer, pixel, word, inv_z);
  const uvec4 bits =
      mix(uvec4(0u), uvec4(1u, 2u, 4u, 8u), greaterThanEqual(forward_high, vec4(0.0)));
  block.flagged |= (bits.x | bits.y | bits.z | bits.w) << (4 * row);
  block.forward = max(
      block.forward, max(max(forward_high.x, forward_high.y), max(forward_high.z, forward_high.w)));
}

uvec2 nodeOf(Extent extent, uint layer, ivec2 origin, Block block, vec4 columns, int row_count) {
  const float inv_z_min = block.box.x;
  const vec4 has_row = vec4(lessThan(ivec4(0, 1, 2, 3), ivec4(row_count)));
  const vec2 counts = vec2(dot(columns, vec4(1.0)), float(row_count));
  const vec4 squares = kPositions * kPositions;
  block.fit.count = counts.x * counts.y;
  block.fit.position = vec2(dot(columns, kPositions), dot(has_row, kPositions)) * counts.yx;
  block.fit.square = vec2(dot(columns, squares), dot(has_row, squares)) * counts.yx;
  if (hasFault(kFaultHoleIsSurface)) block.has_hole = false;
  if (block.has_hole) block.box.x = 0.0;
  if (hasFault(kFaultBoxTooSmall)) {
    block.box.y = uintBitsToFloat(floatBitsToUint(block.box.y) - 4u);
  }
  block.box.y = max(block.box.y, block.forward);
  const uvec2 node =
      planeOrBox(extent, layer, origin, block.fit, block.box, inv_z_min, columns, row_count);
  return block.has_hole || block.forward >= 0.0 ? packBox(kLevelFirst, block.box) : node;
}

void finishBlock(Extent extent, uint layer, uvec2 cell, Block block, vec4 columns, int row_count) {
  const ivec2 origin = ivec2(cell) * kBlockPx;
  if (kLayerCount > 1u) flagForward(extent, layer, origin, block.flagged);
  storeCell(push.layers, layer, extent, kLevelFirst, cell,
            nodeOf(extent, layer, origin, block, columns, row_count));
}

// Row after row: its links upward complete the row above.
void main() {
  const uvec2 cell = uvec2(gl_GlobalInvocationID.x, groupRow());
  const ivec2 origin = ivec2(cell) * kBlockPx;
  if (origin.x >= int(push.width_px)) return;
  const Extent extent = makeExtent(ivec2(push.width_px, push.height_px));
  const Steps steps = Steps(connectedSteps(measured_head), deepSteps(measured_head));
  const ivec2 covered = min(extent.size_px - origin, ivec2(kBlockPx));
  const vec4 columns = vec4(lessThan(ivec4(0, 1, 2, 3), ivec4(covered.x)));
  const bool has_right = origin.x + kBlockPx < extent.size_px.x;

  Block block[kLayerCountMax];
  RowLinks links_above;
  for (uint i = 0u; i < kLayerCount; ++i) {
    block[i] = Block(startFit(), vec2(3.4e38, kNoSurface), kNoSurface, false, 0u);
    links_above.word[i] = uvec4(0u);
    links_above.forward_high[i] = vec4(kNoSurface);
  }
  FacetRow above = loadRow(push.layers, extent, origin - ivec2(0, 1), origin.y > 0);
  int row = 0;
  do {
    const ivec2 pixel = origin + ivec2(0, row);
    const bool exists = pixel.y < extent.size_px.y;
    const FacetRow here = loadRow(push.layers, extent, pixel, exists);
    EdgeLinks to_below;
    EdgeLinks to_above;
    linkAcross(sideOf(above, vec2(0.0, 0.5)), sideOf(here, vec2(0.0, -0.5)), steps, to_below,
               to_above);
    addLinks(links_above, kEdgeBottom, to_below);
    for (uint i = 0u; i < kLayerCount; ++i) {
      if (row > 0) {
        finishRow(block[i], extent, i, pixel - ivec2(0, 1), row - 1, links_above.word[i],
                  links_above.forward_high[i], above.layer[i].inv_z);
      }
      links_above.word[i] = uvec4(0u);
      links_above.forward_high[i] = vec4(kNoSurface);
      const vec4 in_block = row < covered.y ? columns : vec4(0.0);
      addFacets(block[i], here.layer[i], float(row) - 1.5, in_block);
    }
    addLinks(links_above, kEdgeTop, to_above);
    const FacetRow left = loadOne(push.layers, extent, pixel - ivec2(1, 0), exists && origin.x > 0);
    const FacetRow right =
        loadOne(push.layers, extent, pixel + ivec2(kBlockPx, 0), exists && has_right);
    linkColumns(links_above, here, left, right, steps);
    above = here;
    ++row;
  } while (row <= kBlockPx);

  finishBlock(extent, 0u, cell, block[0], columns, covered.y);
  if (kLayerCount > 1u) finishBlock(extent, 1u, cell, block[1], columns, covered.y);
  if (kLayerCount > 2u) finishBlock(extent, 2u, cell, block[2], columns, covered.y);
  if (kLayerCount > 3u) finishBlock(extent, 3u, cell, block[3], columns, covered.y);
}
