// SPDX-License-Identifier: Apache-2.0
// Specialisation, parameters and outputs of trace/walk_views.comp.
#ifndef VIEWLOOM_LIB_WALK_WALK_VIEWS_GLSL_
#define VIEWLOOM_LIB_WALK_WALK_VIEWS_GLSL_

#include "lib/memory.glsl"
#include "shared/lens_abi.h"
#include "shared/trace_abi.h"

layout(constant_id = kIdWanted) const uint kWanted = 0u;  // kWant... flags
layout(constant_id = kIdColorFormat) const uint kColorFormat = kColorRgba8;
layout(constant_id = kIdPixelsPerInvocation) const uint kPixelsPerInvocation = 8u;
layout(constant_id = kIdLanesAreViews) const bool kLanesAreViews = true;
// Colour planes of another size than depth
layout(constant_id = kIdColorIsScaled) const bool kColorIsScaled = false;
// Rays of the whole atlas as makePlainRay takes them; else as makeAnyRay does.
layout(constant_id = kIdRaysArePlain) const bool kRaysArePlain = true;
// All eyes are in the source's plane, or as good as that (server/picture/trace_job.h).
layout(constant_id = kIdEyesInPlane) const bool kEyesInPlane = true;
// Several sources: each answers on its own, and merge_sources.comp makes px of the answers.
layout(constant_id = kIdIsOneOfSeveral) const bool kIsOneOfSeveral = false;
// A face of a cube map: join_faces.comp makes one answer of those of all six.
layout(constant_id = kIdIsCubeFace) const bool kIsCubeFace = false;
layout(constant_id = kIdRays) const uint kRays = kRaysOfPinholes;
layout(constant_id = kIdShownBeside) const uint kShownBeside = 0u;  // kShows... of some tile
layout(constant_id = kIdThroughLens) const bool kThroughLens = false;
// Only for incomplete blocks, an invocation a row of a block.
layout(constant_id = kIdIsOfBlocks) const bool kIsOfBlocks = false;
// Px whose ray ends behind something are listed.
layout(constant_id = kIdListsHidden) const bool kListsHidden = false;
// Not 0: of such px alone, an invocation each, the mean of so many rays through a lens; alpha 0.
layout(constant_id = kIdRaysOfHidden) const uint kRaysOfHidden = 0u;
// On a software device, unfinished runs are listed.
layout(constant_id = kIdListsUnfinished) const bool kListsUnfinished = false;
// Each px has an eye of its own, or several.
const bool kHasOwnEyes = kRays != kRaysOfPinholes || kThroughLens || kRaysOfHidden > 0u;
const bool kIsLayered = kColorFormat == kColorRgba16f;
const bool kLooksBehind = (kShownBeside & kShowsBehind) != 0u;
const bool kSeesThrough = kIsLayered || kLooksBehind;
layout(push_constant, scalar) uniform Push {
  TracePush push;
};

layout(set = 0, binding = kBindingBand, scalar) writeonly buffer Band {
  uint band[];
};
layout(set = 0, binding = kBindingBand, scalar) writeonly buffer Answers {
  RayAnswer answers[];
};
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer RecordsRef {
  RayRecord at[];
};
layout(buffer_reference, scalar, buffer_reference_align = 1) writeonly buffer Uint8Ref {
  uint8_t at[];
};

layout(set = 0, binding = kBindingSums, scalar) buffer Sums {
  vec3 sums[];
};
layout(set = 0, binding = kBindingIncomplete, scalar) buffer Incomplete {
  IncompleteHead incomplete;
  uint incomplete_list[];
};
layout(set = 0, binding = kBindingUnfinished, scalar) buffer Unfinished {
  IncompleteHead unfinished;
  uint unfinished_list[];
};

#endif  // VIEWLOOM_LIB_WALK_WALK_VIEWS_GLSL_
