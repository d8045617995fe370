// SPDX-License-Identifier: Apache-2.0
// Parameters and outputs of the trace kernels.
#ifndef VIEWLOOM_SHADERS_SHARED_TRACE_ABI_H_
#define VIEWLOOM_SHADERS_SHARED_TRACE_ABI_H_

#include "shared/depth_scale.h"
#include "shared/gpu_types.h"
#include "shared/lenticular.h"
#include "shared/structure_abi.h"

VIEWLOOM_ABI_BEGIN

// One output camera, seen from the source. The point at depth s (m along the view's axis) of the
// ray through tile px (x, y) is, in homogeneous image coordinates of the source (px * Z, px * Z,
// Z),
//   eye + s * (direction + x * direction_dx + y * direction_dy).
struct ViewParams {
  vec3 eye;
  vec3 direction;
  vec3 direction_dx;
  vec3 direction_dy;
  // Largest error in inv_z that moves the picture by the display's tolerance, for an eye in the
  // source's plane (1/m); times (1 - inv_z * eye.z)^2 elsewhere. See server/picture/trace_job.h.
  float inv_z_tolerance;
  uint is_used;  // 0: no view stands here
  uint shows;    // kShows... flags: else the colour of the first surface
  // Lens before the view: px of the tile that its rim moves a surface by for each 1/m that its 1/Z
  // lies beside the focus, along both axes; and 1/Z of the focus, 1/m.
  vec2 lens_px_m;
  float lens_inv_focus;
};

VIEWLOOM_ABI_CONST uint kShowsDepth = 1u;   // its depth, as grey of TraceExtras.depth_scale
VIEWLOOM_ABI_CONST uint kShowsBehind = 2u;  // what lies behind that; where nothing does, that

// Rays start a little in front of the largest inv_z of the source (of layer 0); never at 0, it is a
// divisor.
VIEWLOOM_ABI_CONST float kInvZNearMin = 1e-12f;  // 1/m
VIEWLOOM_ABI_CONST float kInvZNearMargin = 1.0001f;

// Columns of the source that an edge is looked for in between two px of a view. Whose px are wider
// shows single samples anyway.
VIEWLOOM_ABI_CONST uint kEdgeColumnsMax = 16u;
// Two px between which one is looked for see inv_z further apart than this times kappa, the least
// step of an edge. Where slopes bring them nearer than that, the edge is left as it is.
VIEWLOOM_ABI_CONST float kEdgeStepKappas = 1.0f;

// Colour is averaged where a px of a view covers more px of the source than this along an axis.
VIEWLOOM_ABI_CONST float kFootprintMin_px = 1.4f;
// And over no more than so far to each side of a sample, px: of 8192 px of a source on a tile of
// 420 px. Further, each px more costs every texel two samples more.
VIEWLOOM_ABI_CONST float kColorReachMax_px = 8.0f;

// A plain ray runs from the near bound, in front of its eye, to infinity. It is no longer than this
// in px, so that positions along it keep 1/256 px with a few roundings of binary32.
VIEWLOOM_ABI_CONST float kPlainExtentMax_px = 16384.0f;

// Values of the mask plane, as proto RayClass.
VIEWLOOM_ABI_CONST uint kClassPadding = 0u;
VIEWLOOM_ABI_CONST uint kClassHit = 1u;
VIEWLOOM_ABI_CONST uint kClassHitAssumed = 2u;
VIEWLOOM_ABI_CONST uint kClassHidden = 3u;
VIEWLOOM_ABI_CONST uint kClassOutside = 4u;
VIEWLOOM_ABI_CONST uint kClassEmpty = 5u;
VIEWLOOM_ABI_CONST uint kClassCount = 6u;

// Rows of a band share kCounterSets sets of counters, from the top: cores that work on rows far
// apart do not wait for each other's cache line.
VIEWLOOM_ABI_CONST uint kCounterSets = 16u;
VIEWLOOM_ABI_CONST uint kCounterStride = 16u;  // of 4 bytes: a cache line

// Where the rays of a px come from: specialisation constant of walk_views.comp and
// merge_sources.comp.
VIEWLOOM_ABI_CONST uint kRaysOfPinholes = 0u;     // all from the eye of their view
VIEWLOOM_ABI_CONST uint kRaysOfMicrolenses = 1u;  // each from the middle of its lens
VIEWLOOM_ABI_CONST uint kRaysOfLenticular = 2u;   // each from where its lens sends a subpixel

// Px of a tile whose x and whose y are equal modulo this pass through the same points of a lens.
VIEWLOOM_ABI_CONST uint kLensPatternSide_px = 8u;
VIEWLOOM_ABI_CONST uint kLensPatternArea_px = kLensPatternSide_px * kLensPatternSide_px;

// A view's eye moved by a metre, in homogeneous image coordinates of the source.
struct EyeAxes {
  vec3 right;
  vec3 up;
  // 1/m: where px stay, seen from beside, along the view's axis; 0 = only at infinity
  float inv_focus;
};

// Microlenses in front of a panel (server/core/display/atlas_layout.h); px from its top left.
struct Microlenses {
  vec2 first_px;  // upper left corner of the first lens
  float pitch_px;
  float slope_per_px;  // by which a ray leans for a px beside its lens's middle; < 0: flipped
  uvec2 count;
  vec2 middle_px;  // of the panel, in front of the display's eye
  float m_per_px;
  float distance_m;  // from the display's eye to the panel
};

// A lenticular panel: which eye on the line of eyes a subpixel is seen from.
struct LenticularEyes {
  Lenticular lens;
  uint channel;     // 0 red, 1 green, 2 blue
  uint view_count;  // views that subpixels show the nearest of; 0 = each its own
  float view_cone_rad;
  float distance_m;  // from the line of eyes to the panel
};

// The full answer to a ray, for tests, statistics and the heat map.
struct RayRecord {
  float x_px;  // of the hit, in the source
  float y_px;
  float inv_z;     // of the hit, in the source; 1/m
  uint ray_class;  // kClass...
  uint layer;      // of the hit; above it, of several sources, which, and which face
  uint visits;     // nodes and facets looked at
};
VIEWLOOM_ABI_CONST uint kRecordSourceShift = 8u;
VIEWLOOM_ABI_CONST uint kRecordFaceShift = 12u;  // of a cube map

// Where a band goes beside its colour, and what few rays need. Addresses of planes that are not
// wanted are 0.
struct TraceExtras {
  Address depth;    // float[rows][width]: 1/Z of the view, 1/m
  Address mask;     // uint8[rows][width]: kClass...
  Address linear;   // vec4[rows][width]: colour before rounding, sRGB-encoded floats
  Address records;  // RayRecord[rows][width]
  // uint[kCounterSets][kCounterStride]: rays by class, added to; the sum over the sets counts
  Address counters;
  // Size of the colour planes, when one is not the depth's size: width | height << 16, and the
  // texels from layer to layer.
  uint color_size_px[kLayerCountMax];
  uint color_stride;
  // The source's pinhole, px of its depth planes: for what several sources are weighed by.
  vec2 focal_px;
  vec2 principal_px;
  // Axes for rays that do not start at their view's eye.
  EyeAxes eye_axes;
  Microlenses microlenses;
  LenticularEyes lenticular;
  DepthScale depth_scale;  // of tiles that show depth
  Address met;             // uint[rows][width]: lib/walk/met_surface.glsl; 0 = not wanted
  uint sample_index;       // which of the rays of each px these are
};

// Answer of one source to a ray when several are asked. Places along the ray are 1/Z of the view,
// 1/m: comparable between sources, larger is nearer.
struct RayAnswer {
  uint ray_class;      // kClass...
  uint layer;          // of the hit
  uint visits;         // nodes and facets looked at
  float view_inv_z;    // of the hit; where the source knows the ray no further without one
  float tolerance;     // by which the hit may be off
  float entry_inv_z;   // from where on the source knows the ray
  float passed_inv_z;  // where the ray first passed behind a surface; kNeverPassed
  float weight;        // of the hit's colour among those of other sources
  uvec2 light;  // four binary16: codes 0..255 before they are rounded, and 1 where they are known
  float x_px;   // of the hit, in the source
  float y_px;
  float inv_z;  // of the hit, in the source; 1/m
};

// Beside the layer in RayAnswer.layer: a reflected ray came out through the surface from behind.
VIEWLOOM_ABI_CONST uint kAnswerIsBack = 0x400u;
VIEWLOOM_ABI_CONST uint kAnswerFaceShift = kRecordFaceShift;  // of a cube map's joined answer

VIEWLOOM_ABI_CONST float kNeverPassed = -1.0f;
// In place of a 1/Z: of who knows nothing of the ray.
VIEWLOOM_ABI_CONST float kKnownNowhere = 1e30f;

// Push constants of merge_sources.comp. Rows of a band, in pieces: answers of one piece are in
// memory at a time.
struct MergePush {
  uint atlas_width_px;
  uint first_row;     // of the piece, in the atlas
  uint band_row;      // of the piece, in the band
  uint tile_size_px;  // width | height << 16
  uint tile_grid;     // columns | rows << 16
  uint padding_top_px;
  uint fill;  // background, red in the low byte
  uint source_count;
  uint answers_stride;  // from one walk's answers to the next
  uvec2 first_walks;    // where those of each source are, 8 bits each
};

// A band: full-width rows of the atlas, top row first. Its colour, uint[rows][width], is sRGB with
// red in the low byte and alpha 255. Views are bound per tile, row-major from the top left.
struct TracePush {
  Address layers[kLayerCountMax];  // of the structure
  Address color[kLayerCountMax];   // texels of the source
  uint source_size_px;             // width | height << 16
  uint layer_count;
  uint atlas_width_px;
  uint first_row;     // of the band, in the atlas
  uint tile_size_px;  // width | height << 16
  uint tile_grid;     // columns | rows << 16
  uint padding_top_px;
  uint fill;  // background, red in the low byte, and kFill... flags
  // Rows of rays whose light is summed, to find blocks of px by.
  uint row_count;        // of the band
  uint first_block_row;  // as in GatherPush
  uint band_row;         // first of the rows that are walked or mirror, in the band
  // Number of the bounce of reflected rays that several walks answer.
  uint bounce;        // of the ray's mirrors, from 0
  uint sample_index;  // of the px's rays
};

VIEWLOOM_ABI_CONST uint kFillBorder = 0x1000000u;  // the image's border goes on where it was left
VIEWLOOM_ABI_CONST uint kFillFirst = 0x2000000u;   // sums of light begin here, or paths of mirrors
// For runs that are listed as unfinished alone (lib/walk/unfinished_runs.glsl).
VIEWLOOM_ABI_CONST uint kFillUnfinished = 0x4000000u;

// Rest of a band that is still to be walked, and its groups of kTraceGroupSize invocations: for
// blocks one invocation for each of their rows, for px one each, for runs a group each.
struct IncompleteHead {
  uvec3 group_count;
  uint count;  // of the uints that follow: places of blocks in the lists, of px in the band, or
               // which run, and its first px
};

// Means of colour along an axis; texels of the source's layers.
struct AveragePush {
  Address layers[kLayerCountMax];  // of the structure
  Address from[kLayerCountMax];
  Address to[kLayerCountMax];
  uint size_px;       // width | height << 16
  float last_weight;  // of the furthest samples to both sides
  uint first_strip;   // along y; along x the first row
};

VIEWLOOM_ABI_CONST uint kBindingUnfinished = 25u;  // storage: IncompleteHead, and uints
VIEWLOOM_ABI_CONST uint kBindingMeans = 14u;       // storage, written: uint per texel of all layers

// One of several samples of a band's px, added to the sums of those before; the last one makes px
// of the sums.
struct BlendPush {
  uint px_count;
  uint is_first;
  uint is_last;
  vec3 weights;    // of its red, green and blue
  Address linear;  // vec4[rows][width] as in TraceExtras, written by the last; or 0
};

VIEWLOOM_ABI_CONST uint kBindingSample = 15u;  // storage, read: uint per px, as in the band
VIEWLOOM_ABI_CONST uint kBindingSums = 16u;    // storage: linear light, vec3 per px

// A band's colour, packed as planes of Y'CbCr.
struct PackPush {
  uint width_px;
  uint row_count;
  uint luma_stride;  // bytes, a multiple of 32
};

VIEWLOOM_ABI_CONST uint kBindingPlanes = 12u;  // storage, written
VIEWLOOM_ABI_CONST uint kPackGroupSize = 64u;
// Hits of two sources are never one surface if their 1/Z differs by more than so much of it: where
// an eye is close to what the source saw from afar, kappa alone would join all there is.
VIEWLOOM_ABI_CONST float kToleranceShareMax = 0.125f;
// Hits of several sources, where a walk asks each on its own: by how much the angle between the
// lines of sight of a view and a source counts as none, rad. A source that stands where the view
// does then has 1e8 times the weight of one that is 1 rad away: its own colours, to the last code.
VIEWLOOM_ABI_CONST float kAngleMin_rad = 1e-4f;
// A surface that a source sees edge on still has so much of its weight.
VIEWLOOM_ABI_CONST float kDensityMin = 1e-6f;

// Specialisation constants of walk_views.comp.
VIEWLOOM_ABI_CONST uint kTraceGroupSize = 64u;
VIEWLOOM_ABI_CONST uint kWantDepth = 1u;
VIEWLOOM_ABI_CONST uint kWantMask = 2u;
VIEWLOOM_ABI_CONST uint kWantLinear = 4u;
VIEWLOOM_ABI_CONST uint kWantRecords = 8u;
VIEWLOOM_ABI_CONST uint kWantMet = 16u;  // what rays met, for the second stage of a lens
VIEWLOOM_ABI_CONST uint kWantSum = 32u;  // the sum of the light of all rays so far, in place of px

#ifdef __cplusplus
static_assert(sizeof(ViewParams) == 72);
static_assert(sizeof(EyeAxes) == 28);
static_assert(sizeof(Microlenses) == 40);
static_assert(sizeof(Lenticular) == 72);
static_assert(sizeof(DepthScale) == 12);
static_assert(sizeof(TraceExtras) == 256);
static_assert(sizeof(RayAnswer) == 52);
static_assert(sizeof(MergePush) == 44);
static_assert(sizeof(TracePush) == 116);
static_assert(sizeof(AveragePush) == 108);
static_assert(sizeof(PackPush) == 12);
static_assert(sizeof(BlendPush) == 32);
static_assert(sizeof(RayRecord) == 24);
static_assert(sizeof(IncompleteHead) == 16);
#endif

VIEWLOOM_ABI_END

#endif  // VIEWLOOM_SHADERS_SHARED_TRACE_ABI_H_
