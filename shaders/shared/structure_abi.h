// SPDX-License-Identifier: Apache-2.0
// The structure of one frame as it lies in device memory.
#ifndef VIEWLOOM_SHADERS_SHARED_STRUCTURE_ABI_H_
#define VIEWLOOM_SHADERS_SHARED_STRUCTURE_ABI_H_

#include "shared/gpu_types.h"

VIEWLOOM_ABI_BEGIN

VIEWLOOM_ABI_CONST uint kLayerCountMax = 4u;

// Node levels: a node of level n covers 2^n x 2^n px. Level 0 are the facets; level 1 is not kept (a
// walk that cannot use a 4x4 node goes straight to the facets).
VIEWLOOM_ABI_CONST uint kLevelFirst = 2u;
VIEWLOOM_ABI_CONST uint kLevelLast = 6u;
VIEWLOOM_ABI_CONST uint kLevelCount = 5u;

// No surface in a column of a layer; lies behind everything.
VIEWLOOM_ABI_CONST float kNoSurface = -1.0f;

// Group sizes of the build kernels: one invocation per px, and per node.
VIEWLOOM_ABI_CONST uint kBuildGroupWidth = 32u;
VIEWLOOM_ABI_CONST uint kBuildGroupHeight = 4u;
VIEWLOOM_ABI_CONST uint kNodeGroupSize = 64u;

// Edges of a facet, in the order of its link word (3 bits each: 0 = silhouette, 1 + k = linked to
// layer k of the neighbouring column).
VIEWLOOM_ABI_CONST uint kEdgeLeft = 0u;
VIEWLOOM_ABI_CONST uint kEdgeRight = 1u;
VIEWLOOM_ABI_CONST uint kEdgeTop = 2u;
VIEWLOOM_ABI_CONST uint kEdgeBottom = 3u;
VIEWLOOM_ABI_CONST uint kLinkBits = 3u;

VIEWLOOM_ABI_CONST uint kDepthSampleF32 = 0u;
VIEWLOOM_ABI_CONST uint kDepthSampleF16 = 1u;
VIEWLOOM_ABI_CONST uint kDepthSampleU16 = 2u;

struct DepthPlane {
  Address samples;   // packed, top row first
  uint sample_type;  // kDepthSample...
  // As frame/depth.h DepthCoefficients, field by field.
  float origin;
  float scale;
  float offset;
  float invalid_value;
  float inv_z_max;
  uint reciprocal;
  uint ray_distance;
  uint has_invalid;
  uint invalid_is_far;
  // Two surfaces of a column no further apart are one: step(w) = x + y w + z w^2, 1/m.
  vec3 format_step;
};

// What a colour plane holds on the device.
VIEWLOOM_ABI_CONST uint kColorRgba8 = 0u;    // sRGB, opaque; one uint a px
VIEWLOOM_ABI_CONST uint kColorRgba16f = 1u;  // linear BT.709, premultiplied; two uints a px

struct ColorPlane {
  Address texels;
  uint width_px;
  uint height_px;
};

// Measured by the build; host visible.
VIEWLOOM_ABI_CONST uint kDepthHistogramBinCount = 2048u;  // 32 bins an octave, 2^-40 .. 2^24 1/m
VIEWLOOM_ABI_CONST uint kNoiseHistogramBinCount = 1024u;  // 16 bins an octave

struct Measured {
  uint bad_samples_count;
  uint unsorted_columns_count;
  uint surface_count;      // of layer 0
  uint inv_z_max_bits;     // float bits, over all layers
  uint inv_z_min_bits;     // float bits, over surfaces of all layers
  float depth_step;        // 1/m
  float noise_sigma;       // 1/m
  float kappa_abs;         // 1/m
  float kappa_rel;
  float inv_z_far;         // 2nd percentile of layer 0, 1/m
  float inv_z_near;        // 98th percentile of layer 0, 1/m
  uint depth_histogram[kDepthHistogramBinCount];  // of inv_z, layer 0
  uint noise_histogram[kNoiseHistogramBinCount];  // of second differences of inv_z, layer 0
};

struct Structure {
  uint width_px;
  uint height_px;
  uint layer_count;
  uint color_format;            // kColor...
  float focal_x_px;
  float focal_y_px;
  float principal_x_px;
  float principal_y_px;
  float given_kappa;            // 1/m; 0 = measured
  Address measured;             // Measured
  Address inv_z[kLayerCountMax];    // float[height][width]
  Address facets[kLayerCountMax];   // uvec2[height][width]: inv_z bits, slopes (lib/facet.glsl)
  Address links[kLayerCountMax];    // uint16[height][width]
  Address entries[kLayerCountMax];  // uvec2 per level-2 cell: its largest planar ancestor, else itself
  Address nodes[kLayerCountMax];    // uvec2, levels 2..6 one after the other (level_offset)
  uint level_offset[kLevelCount];   // in nodes, of level kLevelFirst + i
  uint level_width[kLevelCount];    // in nodes
  uint level_height[kLevelCount];
  ColorPlane color[kLayerCountMax];
  DepthPlane depth[kLayerCountMax];
};

// Push constants of every build kernel.
struct BuildPush {
  Address structure;
  uint layer;
  uint level;
};

// Source of convert_color.comp: an RGBA8 or RGBA16F plane of any transfer, primaries and alpha.
VIEWLOOM_ABI_CONST uint kPrimariesBt709 = 0u;
VIEWLOOM_ABI_CONST uint kPrimariesDisplayP3 = 1u;
VIEWLOOM_ABI_CONST uint kPrimariesBt2020 = 2u;
VIEWLOOM_ABI_CONST uint kAlphaOpaque = 0u;
VIEWLOOM_ABI_CONST uint kAlphaPremultiplied = 1u;
VIEWLOOM_ABI_CONST uint kAlphaStraight = 2u;

struct ConvertColorPush {
  Address from;
  Address to;  // RGBA16F, linear BT.709, premultiplied
  uint texel_count;
  uint from_format;  // kColor...
  uint is_linear;
  uint primaries;    // kPrimaries...
  uint alpha;        // kAlpha...
  float light_scale;  // 2^exposure
};

#ifdef __cplusplus
static_assert(sizeof(DepthPlane) == 60);
static_assert(sizeof(ColorPlane) == 16);
static_assert(offsetof(Measured, noise_histogram) == 44 + 4 * kDepthHistogramBinCount);
static_assert(offsetof(Structure, inv_z) == 44);
static_assert(offsetof(Structure, level_offset) == 44 + 5 * 32);
static_assert(sizeof(Structure) == 44 + 5 * 32 + 3 * 20 + 4 * 16 + 4 * 60);
static_assert(sizeof(BuildPush) == 16);
static_assert(sizeof(ConvertColorPush) == 40);
#endif

VIEWLOOM_ABI_END

#endif  // VIEWLOOM_SHADERS_SHARED_STRUCTURE_ABI_H_
