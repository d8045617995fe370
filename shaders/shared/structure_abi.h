// SPDX-License-Identifier: Apache-2.0
// The structure of one frame as it lies in device memory, and what its kernels are told.
//
// Values that every pixel needs come by push constants and bindings. On software devices, a load
// through an address costs five times one through a storage binding, and thirteen times a texel
// fetch (shaders/README.md, Memory). Addresses serve data larger than the device's bindings.
#ifndef VIEWLOOM_SHADERS_SHARED_STRUCTURE_ABI_H_
#define VIEWLOOM_SHADERS_SHARED_STRUCTURE_ABI_H_

#include "shared/gpu_types.h"

VIEWLOOM_ABI_BEGIN

VIEWLOOM_ABI_CONST uint kLayerCountMax = 4u;

// A layer of a structure is one array of cells (uvec2), level after level, then the links:
//   nodes    levels 6..2: a node of level n covers 2^n x 2^n px
//   entries  one per 4x4 px: where a walk enters it. They stand for level 1, which is not kept: a
//            walk that cannot use a 4x4 node goes straight to the facets.
//   facets   level 0, one per px
//   links    uint16 per px, in the order of the facets
// Both sides of the image are rounded up to whole nodes of the last level, so every level is
// exactly a quarter of the one below it and no table of offsets is needed. What lies outside the
// image is never read.
VIEWLOOM_ABI_CONST uint kLevelFacets = 0u;
VIEWLOOM_ABI_CONST uint kLevelEntries = 1u;
VIEWLOOM_ABI_CONST uint kLevelFirst = 2u;
VIEWLOOM_ABI_CONST uint kLevelLast = 6u;

// Where the cells of a level begin, for sides already rounded up; area = width * height. The last
// level comes first. In units of its cell count n: levels 6, 5, 4, 3, 2 begin at 0, 1, 5, 21, 85,
// which are the leading bits of 0b10101010101; the entries at 341 by the same rule; the facets at
// 597.
VIEWLOOM_ABI_FUNCTION uint levelOffset(uint level, uint padded_area) {
  const uint before = level == kLevelFacets ? 597u : 0x555u >> (2u * level);
  return before * (padded_area / 4096u);
}

// Cells of all levels of a layer: the links begin behind them.
VIEWLOOM_ABI_FUNCTION uint cellCount(uint padded_area) {
  return levelOffset(kLevelFacets, padded_area) + padded_area;
}

// 8-byte words of a layer: cells, then links. Layer k of an undivided structure begins at k times
// this.
VIEWLOOM_ABI_FUNCTION uint layerWords(uint padded_area) {
  return cellCount(padded_area) + padded_area / 4u;
}

// Bindings, all in set 0.
// Texels of two uints: all layers, one after the other
VIEWLOOM_ABI_CONST uint kBindingStructure = 0u;
VIEWLOOM_ABI_CONST uint kBindingColor = 1u;         // texels of one or two uints: all layers
VIEWLOOM_ABI_CONST uint kBindingInvZ = 2u;          // texels of one float: all layers
VIEWLOOM_ABI_CONST uint kBindingSamples = 3u;       // texels of one uint: the upload
VIEWLOOM_ABI_CONST uint kBindingInvZOut = 4u;       // storage, written: inv_z of all layers
VIEWLOOM_ABI_CONST uint kBindingStructureOut = 5u;  // storage, written: the cells of all layers
VIEWLOOM_ABI_CONST uint kBindingDepthPlanes = 6u;   // uniform: DepthPlanes
VIEWLOOM_ABI_CONST uint kBindingMeasured = 7u;      // uniform: MeasuredHead
VIEWLOOM_ABI_CONST uint kBindingViews = 8u;         // storage, read: ViewParams per tile
VIEWLOOM_ABI_CONST uint kBindingExtras = 9u;        // uniform: TraceExtras
VIEWLOOM_ABI_CONST uint kBindingBand = 10u;         // storage, written: uint per px
// Texels of one uint: all layers of the structure, for who needs half a word
VIEWLOOM_ABI_CONST uint kBindingStructureHalves = 11u;
VIEWLOOM_ABI_CONST uint kBindingAnswers = 13u;  // storage: RayAnswer per px of each source

// In the first word of a facet: no surface. Any other facet holds its inv_z there (never negative),
// with the sign set when a link of its column leads from this layer or a deeper one to one before
// this layer: a walk of this layer must look at such an edge.
VIEWLOOM_ABI_CONST uint kNoFacet = 0xffffffffu;
VIEWLOOM_ABI_CONST uint kForwardLinkFlag = 0x80000000u;

// inv_z of a column without a surface in this layer; lies behind everything.
VIEWLOOM_ABI_CONST float kNoSurface = -1.0f;

// Edges of a facet, in the order of its link word (3 bits each: 0 = silhouette, 1 + k = linked to
// layer k of the neighbouring column, or a silhouette as below).
VIEWLOOM_ABI_CONST uint kEdgeLeft = 0u;
VIEWLOOM_ABI_CONST uint kEdgeRight = 1u;
VIEWLOOM_ABI_CONST uint kEdgeTop = 2u;
VIEWLOOM_ABI_CONST uint kEdgeBottom = 3u;
VIEWLOOM_ABI_CONST uint kLinkBits = 3u;
// The far side of a deep silhouette: beyond it the same layer is nearer by more than a deep step.
// Two things then, of which a sample beside the edge may show a bit of both; what steps by less may
// be one that is steep.
VIEWLOOM_ABI_CONST uint kDeepEdge = 7u;
// A deep step, as a share of the nearer one's distance from MeasuredHead.inv_z_base.
VIEWLOOM_ABI_CONST float kDeepStep = 0.15f;
// Beside nothing a far side is looked for at distances that double: up to 128 px away.
VIEWLOOM_ABI_CONST uint kFarSideProbes = 8u;
// The near side of a silhouette, if a deeper layer holds on this side of the edge what is as far
// back as the far side, or further: so that is known, and need not be thought to go on.
VIEWLOOM_ABI_CONST uint kKnownBehind = 6u;
// Set in the link word of every facet that exists.
VIEWLOOM_ABI_CONST uint kFacetExists = 0x1000u;

// Build kernels take blocks of px, an invocation each, in groups of one dimension.
VIEWLOOM_ABI_CONST int kBlockPx = 4;
VIEWLOOM_ABI_CONST uint kNodeGroupSize = 64u;
VIEWLOOM_ABI_CONST int kMeasuredBlocks = 8;  // side by side, an invocation of measure_depth.comp

// inv_z of a layer lies in rows of a pitch of its own, with a guard of no surface around the image:
// whole blocks above and below, at least two px to the right of each row, which are also those to
// the left of the next.
VIEWLOOM_ABI_FUNCTION uint invZPitch(uint width_px) {
  return (width_px + 5u) & ~3u;
}

VIEWLOOM_ABI_FUNCTION uint invZArea(uint width_px, uint height_px) {
  return invZPitch(width_px) * (((height_px + 3u) & ~3u) + 8u);
}

VIEWLOOM_ABI_FUNCTION uint invZIndex(uint pitch, uint x, int y) {
  return uint(y + kBlockPx) * pitch + x;
}

// Coarse depth is smoothed in passes, each over neighbours half as far away (shaders/structure.md).
VIEWLOOM_ABI_CONST uint kSmoothingPassCount = 8u;
VIEWLOOM_ABI_CONST uint kFirstShortPass = 4u;  // of those that noise takes

VIEWLOOM_ABI_FUNCTION int smoothingStride(uint pass) {
  return pass < 5u ? 32 >> pass : 1;
}

// A pair of neighbours of one plane, all within `reach` of it, bends by no more than 2 reaches;
// what bends, or rises from one to the other, by more than that counts less, down to nothing here.
// Powers of two, so that no kernel rounds otherwise than another.
VIEWLOOM_ABI_CONST float kPairReaches = 4.0f;
VIEWLOOM_ABI_CONST float kSmoothingShare = 0.125f;    // of each of four pairs
VIEWLOOM_ABI_CONST float kSmoothingGapShare = 0.25f;  // of the way to the next layer, at most

// A face of a cube map is surrounded by so many px of its neighbours, seen by its own pinhole.
VIEWLOOM_ABI_CONST uint kCubeApron_px = 2u;

// How a depth sample is stored.
VIEWLOOM_ABI_CONST uint kDepthSampleF32 = 0u;
VIEWLOOM_ABI_CONST uint kDepthSampleF16 = 1u;
VIEWLOOM_ABI_CONST uint kDepthSampleU16 = 2u;
// Sample type of a kernel for layers that differ.
VIEWLOOM_ABI_CONST uint kDepthSampleMixed = 3u;

// How one depth plane becomes inv_z. The coefficients are those of frame/depth.h DepthCoefficients.
struct DepthPlane {
  uint first_sample;  // in the upload, in samples of its size
  uint sample_type;   // kDepthSample...
  float origin;
  float scale;
  float offset;
  float invalid_value;
  float inv_z_max;
  uint reciprocal;
  uint ray_distance;
  uint has_invalid;
  float invalid_inv_z;  // 0, or kNoSurface. Chosen between on the device, 0 would get a sign there.
};

struct DepthPlanes {
  Address samples;  // the upload
  vec2 focal_px;
  vec2 principal_px;
  DepthPlane planes[kLayerCountMax];
};

// Push constants of the build kernels.
struct BuildPush {
  Address inv_z[kLayerCountMax];   // float[], see invZIndex
  Address layers[kLayerCountMax];  // cells and links, see above
  Address measured;                // Measured
  uint width_px;
  uint height_px;
  uint layer_count;
  uint apron_px;      // around what was uploaded: kCubeApron_px, or 0
  uint level;         // build_level.comp; the pass of smooth_columns.comp
  float given_kappa;  // 1/m; 0 = measured
  // Two surfaces of a column no further apart are one: step(w) = x + y w + z w^2, 1/m. Of the
  // coarsest layer in each term.
  vec3 format_step;
  uint first_group_row;  // of a dispatch
};

// Measured by the build.
VIEWLOOM_ABI_CONST uint kDepthHistogramBinCount = 2048u;  // 32 bins an octave, 2^-40 .. 2^24 1/m
VIEWLOOM_ABI_CONST uint kNoiseHistogramBinCount = 1024u;  // 16 bins an octave
VIEWLOOM_ABI_CONST uint kRangeHistogramBinCount = 1024u;  // of equal width, over RangeBounds

// Where the percentiles of inv_z lie, by the bins of the depth histogram.
struct RangeBounds {
  float begin;           // 1/m
  float bins_per_inv_z;  // 0: there is no range
  uint below_count;      // samples before the begin
  uint surface_count;    // all samples
};

struct MeasuredHead {
  uint bad_samples_count;
  uint unsorted_columns_count;
  uint inv_z_max_bits;  // float bits, over all layers
  uint inv_z_min_bits;  // float bits, over surfaces of all layers
  float depth_step;     // 1/m
  float noise_sigma;    // 1/m
  // Steps between two surfaces, 1/m (shaders/structure.md, Steps): the least, and a share of how
  // far the nearer one is before inv_z_base.
  float kappa_abs;  // within a surface
  float kappa_rel;
  float deep_abs;  // between two things; its share is kDeepStep
  float inv_z_base;
  float inv_z_far;        // 2nd percentile of layer 0, 1/m
  float inv_z_near;       // 98th percentile of layer 0, 1/m
  float smoothing_reach;  // how far smoothing may move a sample, 1/m
  uint first_smoothing_pass;
  // Groups of smooth_columns.comp, before kFirstShortPass and from there on: none where depth is
  // fine.
  uvec3 long_groups;
  uvec3 short_groups;
  RangeBounds range;
};

struct Measured {
  MeasuredHead head;
  uint depth_histogram[kDepthHistogramBinCount];  // of inv_z, layer 0
  uint noise_histogram[kNoiseHistogramBinCount];  // of second differences of inv_z, layer 0
  uint range_histogram[kRangeHistogramBinCount];  // of inv_z between both percentiles, layer 0
  uint changing_count;  // where inv_z is not the same in all three px, layer 0
};

// Contents of a colour plane on the device.
VIEWLOOM_ABI_CONST uint kColorRgba8 = 0u;    // sRGB, opaque; one uint a px
VIEWLOOM_ABI_CONST uint kColorRgba16f = 1u;  // linear BT.709, premultiplied; two uints a px
VIEWLOOM_ABI_CONST uint kColorRgb16 = 2u;    // light of BT.709 to 1 / 2.4, opaque; two uints a px
VIEWLOOM_ABI_CONST uint kColorCodes11 = 3u;  // means of others: codes of sRGB; one uint a px

// Parameters of convert_color.comp for a plane.
VIEWLOOM_ABI_CONST uint kPrimariesBt709 = 0u;
VIEWLOOM_ABI_CONST uint kPrimariesDisplayP3 = 1u;
VIEWLOOM_ABI_CONST uint kPrimariesBt2020 = 2u;
VIEWLOOM_ABI_CONST uint kAlphaOpaque = 0u;
VIEWLOOM_ABI_CONST uint kAlphaPremultiplied = 1u;
VIEWLOOM_ABI_CONST uint kAlphaStraight = 2u;

struct ConvertColorPush {
  Address from;
  Address to;
  uint texel_count;
  uint from_format;  // kColorRgba8 or kColorRgba16f, of any transfer, primaries and alpha
  uint to_format;    // kColorRgba16f or, of what is opaque, kColorRgb16
  uint is_linear;
  uint primaries;     // kPrimaries...
  uint alpha;         // kAlpha...
  float light_scale;  // 2^exposure
  uint tone_map;      // kToneMap... (shared/tone_map.h), of linear planes
};

#ifdef __cplusplus
static_assert(sizeof(DepthPlanes) == 24 + 44 * kLayerCountMax);
static_assert(sizeof(BuildPush) == 112);
static_assert(offsetof(Measured, noise_histogram) == 96 + 4 * kDepthHistogramBinCount);
static_assert(sizeof(ConvertColorPush) == 48);
#endif

VIEWLOOM_ABI_END

#endif  // VIEWLOOM_SHADERS_SHARED_STRUCTURE_ABI_H_
