// SPDX-License-Identifier: Apache-2.0
// Where a walk begins, and what it answers.
#ifndef VIEWLOOM_LIB_WALK_WALK_STATE_GLSL_
#define VIEWLOOM_LIB_WALK_WALK_STATE_GLSL_

#include "lib/walk/walk_edges.glsl"

// A walk begins in the state of its first column (kStateUnknown), or behind the layers <
// behind_count and in front of the others, at a surface that was seen through.
const uint kStateUnknown = 0xffu;

// Kinds of surfaces that a kernel's walks meet. Constants: compilers leave out what they rule out.
struct WalkRules {
  bool sees_through;  // walks may begin at surfaces that were seen through
  // A ray that comes out through a surface from behind has met what the surface hides, and ends
  // there.
  bool meets_backs;
};

const WalkRules kSeesFirstSurfaces = WalkRules(false, false);
const WalkRules kSeesThroughSurfaces = WalkRules(true, false);

struct WalkStart {
  float t;
  ivec2 cell;
  uint behind_count;
};

struct Walk {
  bool is_hit;
  bool is_assumed;    // was behind known surface before the hit
  bool ends_behind;   // no hit, and behind known surface at the end
  bool leaves;        // the ray's end is not at inv_z = 0
  float t;            // of the hit; the ray's end without
  ivec2 cell;         // of the hit; the last column without
  uint layer;         // of the hit
  uint level;         // of the plane hit; kLevelFacets: of one facet, or an edge
  float passed_t;     // where it first passed behind known surface; 2 = never
  // Passed behind a silhouette: the column before the last one, and the layer there, whose surface
  // the ray was in front of. Behind that layer from the beginning: the first column. From over no
  // surface at all: the column without one, and has_far_side is false.
  bool has_far_side;
  ivec2 far_cell;
  uint far_layer;
  // Where the ray passed it, across which axis, and how far up the step from the far side to the
  // near one, 0..1; 0 where the silhouette is deep.
  float far_t;
  uint far_axis;
  float far_share;
  bool is_back;  // the hit: from behind, through a surface that was only seen from the other side
  uint visits;
};

// A ray that never sees the image continues the border next to where it goes.
Walk walkBeside(WalkStart start) {
  return Walk(false, false, false, true, 1.0, start.cell, 0u, kLevelFacets, 2.0, false,
              start.cell, 0u, 0.0, kAxisNone, 0.0, false, 0u);
}

#endif  // VIEWLOOM_LIB_WALK_WALK_STATE_GLSL_
