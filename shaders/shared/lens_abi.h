// SPDX-License-Identifier: Apache-2.0
// Additional parameters and outputs of the kernels of a lens.
#ifndef VIEWLOOM_SHADERS_SHARED_LENS_ABI_H_
#define VIEWLOOM_SHADERS_SHARED_LENS_ABI_H_

#include "shared/gpu_types.h"
#include "shared/structure_abi.h"

VIEWLOOM_ABI_BEGIN

// The second stage of a lens: surfaces that the walked rays of a block of px met, each once.
struct GatherPush {
  Address layers[kLayerCountMax];  // of the structure
  Address color[kLayerCountMax];   // texels of the source
  uint source_size_px;             // width | height << 16
  uint layer_count;
  uint atlas_width_px;
  uint first_row;  // of the band, in the atlas
  uint row_count;
  uint tile_size_px;  // width | height << 16
  uint tile_grid;     // columns | rows << 16
  uint padding_top_px;
  uint fill;             // as in TracePush
  uint first_block_row;  // of blocks of all tile rows: that of the band's first row
  uint piece_row;        // of the band: where the rows begin that are gathered
  uint walked_count;     // points of the lens that are for walked rays
  uint point_count;      // and those for gathered ones
  uint first_sample;     // of the round of walked rays that is listed
  uint end_sample;
};

// A plane of 1/Z over the image of the source: surfaces of a layer that rays met lie on it, to
// within its reach (shared/sheet_reach.h).
struct MetSheet {
  vec3 plane;  // inv_z = x plane.x + y plane.y + plane.z, x and y in px
  uint layer;
  float reach;  // 1/m
};

VIEWLOOM_ABI_CONST uint kMetBlockSide_px = 8u;
VIEWLOOM_ABI_CONST uint kMetSheetMax = 12u;

// Sheets that the walked rays of a block met. If there are too many, only the walked rays count:
// the count is kMetTooMany.
struct MetList {
  uint walked_count;  // rays of each px
  uint count;
  uint kinds;  // kMet...
  MetSheet sheets[kMetSheetMax];
};
VIEWLOOM_ABI_CONST uint kMetTooMany = 0xffu;
// The first rays of its px met one sheet, or the background, all of them.
VIEWLOOM_ABI_CONST uint kMetSettled = 1u;
VIEWLOOM_ABI_CONST uint kMetSeesBackground = 2u;  // some ray
VIEWLOOM_ABI_CONST uint kMetSeesAssumed = 4u;     // some ray, without having met it
// It is settled, or a round of rays met nothing new: no more are walked.
VIEWLOOM_ABI_CONST uint kMetComplete = 8u;

// In place of a surface: nothing, and what is assumed where rays pass behind what is known.
VIEWLOOM_ABI_CONST uint kMetBackground = 0xfffffffeu;
VIEWLOOM_ABI_CONST uint kMetAssumed = 0xffffffffu;
// storage: lib/walk/met_surface.glsl, [sample][row][width]
VIEWLOOM_ABI_CONST uint kBindingMet = 17u;
VIEWLOOM_ABI_CONST uint kBindingMetLists = 18u;  // storage: MetList per block
// storage: vec2[kLensPatternArea_px]: where rays pass through the lens, by place in the pattern; of
// the second stage, [point][kLensPatternArea_px]
VIEWLOOM_ABI_CONST uint kBindingLensPoints = 19u;
VIEWLOOM_ABI_CONST uint kBindingIncomplete = 23u;  // storage: IncompleteHead, and uints

#ifdef __cplusplus
static_assert(sizeof(MetList) == 252);
static_assert(sizeof(GatherPush) == 124);
#endif

VIEWLOOM_ABI_END

#endif  // VIEWLOOM_SHADERS_SHARED_LENS_ABI_H_
