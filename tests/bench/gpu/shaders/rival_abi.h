// SPDX-License-Identifier: Apache-2.0
// Parameters of the rivals' kernels.
#ifndef VIEWLOOM_BENCH_GPU_SHADERS_RIVAL_ABI_H_
#define VIEWLOOM_BENCH_GPU_SHADERS_RIVAL_ABI_H_

#include "shared/trace_abi.h"

VIEWLOOM_ABI_BEGIN

// Bindings beside those of shared/structure_abi.h, of which the rivals have kBindingColor,
// kBindingInvZ, kBindingViews and kBindingBand.
VIEWLOOM_ABI_CONST uint kBindingBoxes = 16u;     // texels of one uint: the min/max pyramid
VIEWLOOM_ABI_CONST uint kBindingBoxesOut = 17u;  // storage, written: a layer of it
VIEWLOOM_ABI_CONST uint kBindingHits = 18u;      // texels of two uints: what rays hit
VIEWLOOM_ABI_CONST uint kBindingFrom = 19u;      // texels of four uints: copied
VIEWLOOM_ABI_CONST uint kBindingTo = 20u;        // storage, written: the copies

// Parameters of a dispatch that traces rows of an atlas.
struct RivalPush {
  uint source_size_px;  // width | height << 16
  uint layer_count;
  uint atlas_width_px;
  uint first_row;     // of the dispatch, in the atlas
  uint tile_size_px;  // width | height << 16
  uint tile_grid;     // columns | rows << 16
  uint padding_top_px;
  uint fill;         // as TracePush
  float inv_z_near;  // a little in front of everything, > 0
  vec3 kappa;        // least (1/m), share, from (1/m): StepRule
  uint box_stride;   // texels from layer to layer of the pyramid
};

// A known hit: its px, x | y << 16; then its layer and where in the px it lies, 0..256 of 256 from
// the top left. Without kHitExists: the px's colour.
VIEWLOOM_ABI_CONST uint kHitExists = 0x80000000u;
VIEWLOOM_ABI_CONST uint kHitOffsetXShift = 2u;
VIEWLOOM_ABI_CONST uint kHitOffsetYShift = 11u;

VIEWLOOM_ABI_CONST uint kBoxLevelLast = 6u;

// Parameters of a pass that makes levels of a layer's pyramid.
struct BoxesPush {
  uint source_size_px;  // width | height << 16
  uint layer;
  uint level;       // the highest that is there; 0: none
  uint box_stride;  // as RivalPush
  vec3 kappa;       // as RivalPush
};

// Parameters of a copy, in units of 16 bytes.
struct CopyPush {
  uint from_first;
  uint from_count;
  uint to_count;   // >= from_count
  uint row_count;  // invocations along x
};

// How reflected rays are marched, beside a TracePush.
struct MarchKnobs {
  uint layer_stride;    // px from place to place, and above them, from kMarchLayerShift on, layers
  uint step_count_max;  // places that are looked at
  float thickness_m;    // of a sample
};
VIEWLOOM_ABI_CONST uint kMarchLayerShift = 16u;

#ifdef __cplusplus
static_assert(sizeof(RivalPush) == 52);
static_assert(sizeof(MarchKnobs) == 12);
static_assert(sizeof(CopyPush) == 16);
static_assert(sizeof(BoxesPush) == 28);
#endif

VIEWLOOM_ABI_END

#endif  // VIEWLOOM_BENCH_GPU_SHADERS_RIVAL_ABI_H_
