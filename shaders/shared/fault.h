// SPDX-License-Identifier: Apache-2.0
// Mistakes that tests plant in the build, the walk and reflections, to prove that they would be
// found. Every product kernel is compiled with none: the constant folds the branches away.
#ifndef VIEWLOOM_SHADERS_SHARED_FAULT_H_
#define VIEWLOOM_SHADERS_SHARED_FAULT_H_

#include "shared/gpu_types.h"

VIEWLOOM_ABI_BEGIN

// Id of the specialisation constant that names the planted mistake.
VIEWLOOM_ABI_CONST uint kFaultConstantId = 31u;

VIEWLOOM_ABI_CONST uint kFaultNone = 0u;
// In the build.
VIEWLOOM_ABI_CONST uint kFaultSlopeSign = 1u;      // facets lean the wrong way along y
VIEWLOOM_ABI_CONST uint kFaultCrossLinks = 2u;     // no links between different layers
VIEWLOOM_ABI_CONST uint kFaultHoleIsSurface = 3u;  // blocks do not notice their holes
// Boxes of blocks lose their margin and an ulp
VIEWLOOM_ABI_CONST uint kFaultBoxTooSmall = 4u;
VIEWLOOM_ABI_CONST uint kFaultChildForgotten = 5u;    // a level leaves one node below it out
VIEWLOOM_ABI_CONST uint kFaultErrorUnderstated = 6u;  // planes state a quarter of their error
VIEWLOOM_ABI_CONST uint kFaultGapPassed = 7u;         // smoothing moves layers through each other
VIEWLOOM_ABI_CONST uint kFaultApronEmpty = 8u;        // faces of a cube map end at their edges
VIEWLOOM_ABI_CONST uint kFaultFaceTurned = 9u;        // their neighbours surround them upside down
// Steps between surfaces are shares of inv_z itself
VIEWLOOM_ABI_CONST uint kFaultStepsFromInfinity = 10u;
// In the walk.
VIEWLOOM_ABI_CONST uint kFaultLayerDropped = 16u;    // only layer 0 is walked
VIEWLOOM_ABI_CONST uint kFaultPlaneOff = 17u;        // planes are evaluated a px aside
VIEWLOOM_ABI_CONST uint kFaultNeverClimbs = 18u;     // a walk that descended stays with the facets
VIEWLOOM_ABI_CONST uint kFaultBehindIsHit = 19u;     // passing behind a silhouette counts as a hit
VIEWLOOM_ABI_CONST uint kFaultLinks = 20u;           // connected surfaces have cracks
VIEWLOOM_ABI_CONST uint kFaultEntryInFront = 21u;    // whoever enters from the side is in front
VIEWLOOM_ABI_CONST uint kFaultErrorIgnored = 22u;    // every plane is taken, whatever its error
VIEWLOOM_ABI_CONST uint kFaultFarSideEnds = 23u;     // far sides end at their silhouettes
VIEWLOOM_ABI_CONST uint kFaultFarSideEndless = 24u;  // far sides go on however far
// In the merge of several sources.
VIEWLOOM_ABI_CONST uint kFaultFarthestHit = 32u;     // the farthest hit wins
VIEWLOOM_ABI_CONST uint kFaultWeightsSwapped = 33u;  // what should count little counts much
VIEWLOOM_ABI_CONST uint kFaultHiddenWins = 34u;      // one source that is hidden hides all
VIEWLOOM_ABI_CONST uint kFaultNoRefuting = 35u;      // assumed hits in free space stand
VIEWLOOM_ABI_CONST uint kFaultNoBlend = 36u;         // the nearest hit alone counts
// In the join of the faces of a cube map.
VIEWLOOM_ABI_CONST uint kFaultFirstFaceEnds = 48u;   // the face that a ray begins in says it all
VIEWLOOM_ABI_CONST uint kFaultSeamPassed = 49u;      // what is hit in the seam never counts
VIEWLOOM_ABI_CONST uint kFaultSeamForgets = 50u;     // who was behind a surface is not any more
VIEWLOOM_ABI_CONST uint kFaultCubeSawNothing = 51u;  // nor is what is free told to other sources
// In reflections.
VIEWLOOM_ABI_CONST uint kFaultStartsOnSurface = 64u;  // rays start where they are mirrored
VIEWLOOM_ABI_CONST uint kFaultNormalTurned = 65u;     // mirrors face the other way along x
VIEWLOOM_ABI_CONST uint kFaultNotBent = 66u;          // who goes below its own facet stays there
VIEWLOOM_ABI_CONST uint kFaultBacksPassed = 67u;      // who comes out through a surface goes on
VIEWLOOM_ABI_CONST uint kFaultBeginsBehind = 68u;     // rays begin behind their own surface
VIEWLOOM_ABI_CONST uint kFaultBodiesFlat = 69u;       // bodies are as thin as their fronts

VIEWLOOM_ABI_END

#endif  // VIEWLOOM_SHADERS_SHARED_FAULT_H_
