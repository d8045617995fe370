// SPDX-License-Identifier: Apache-2.0
// Additional parameters and outputs of the kernels of reflections.
#ifndef VIEWLOOM_SHADERS_SHARED_REFLECTION_ABI_H_
#define VIEWLOOM_SHADERS_SHARED_REFLECTION_ABI_H_

#include "shared/ggx.h"
#include "shared/gpu_types.h"
#include "shared/surface_abi.h"
#include "shared/trace_abi.h"

VIEWLOOM_ABI_BEGIN

VIEWLOOM_ABI_CONST uint kBindingSurface = 20u;     // texels of two uints: SurfaceTexel, all layers
VIEWLOOM_ABI_CONST uint kBindingReflection = 21u;  // uniform: ReflectionSettings
VIEWLOOM_ABI_CONST uint kBindingReflected = 22u;   // storage: ReflectedLight per px of a band
VIEWLOOM_ABI_CONST uint kBindingPaths = 24u;       // storage: ReflectedPath per px of a piece
VIEWLOOM_ABI_CONST uint kBindingAlbedos = 26u;     // storage: the table of shared/ggx.h

struct ReflectionSettings {
  Address surfaces[kLayerCountMax];  // SurfaceTexel of each layer
  vec3 environment;                  // linear light
  float tolerance_px;                // of the display
  uint bounce_count;                 // along one ray
  uint sample_count;                 // rays a px of a rough surface
  // Which of several walks it is that is told; and its source and face as in RayRecord.layer, from
  // kRecordSourceShift on.
  uint walk;
  uint recorded_as;
  // The first walk's camera as this one's sees it: axes to its right, down and forward, and place.
  // Metres; x to the right, y down, z along the axis.
  vec3 first_right;
  vec3 first_down;
  vec3 first_forward;
  vec3 first_place;
  // The same axes of the camera in which the surfaces' normals are told: of a cube map's.
  vec3 source_right;
  vec3 source_down;
  vec3 source_forward;
};

// A reflected ray of a px that several walks are asked about, and what those before it found.
// Metres of the first walk's camera.
struct ReflectedPath {
  uint sample_count;  // of the px's rays; 0 = what it shows mirrors nothing
  uint is_on;         // whether there is a ray now
  uint is_bent;       // along the surface that it starts from
  // The surface that it starts from; until it is turned there, all but the layer is of the one it
  // met.
  uint walk;
  uint layer;
  vec3 spot;            // x px, y px, inv_z of that walk
  float surface_error;  // by which it starts in front of that, 1/m
  float apart_m;        // what others have so far from there may be the same surface
  vec3 start;
  vec3 direction;  // unit length
  vec3 eye;        // where it seems to come from, behind all mirrors so far
  float px_angle;  // of the view
  float moved_px;  // that an error may move the picture by, over the view's focal length
  vec3 share;      // of the light that it finds
  vec3 own_share;  // of that of this sample which the px's surface mirrors
  vec3 light;      // that this sample has found
  // Sum over all samples before.
  vec3 light_sum;
  vec3 share_sum;
  float closeness_sum;  // 1/m
  // Reflectance of the pixel's surface, in the form of ReflectedLight.
  uint reflectance;
  uint place;
};

// Push constants of merge_paths.comp.
struct MergePathsPush {
  Address counters;  // as in TraceExtras
  uint atlas_width_px;
  uint band_row;  // of the piece, in the band
  // The same as in MergePush.
  uint source_count;
  uint answers_stride;
  uvec2 first_walks;
  // A bit for each source.
  uint cube_maps;
  uint mirrors;
  uint bounce;  // of the ray's mirrors, from 0
  uint bounce_count;
  uint sample_index;  // of the px's rays
  uint sample_count;  // of the px with the most
  vec3 environment;   // linear light
};

// Where reflected rays ended; places in a set of the trace's counters, behind those of classes.
VIEWLOOM_ABI_CONST uint kReflectionHit = 8u;
VIEWLOOM_ABI_CONST uint kReflectionAssumed = 9u;
VIEWLOOM_ABI_CONST uint kReflectionBack = 10u;
VIEWLOOM_ABI_CONST uint kReflectionCube = 11u;
VIEWLOOM_ABI_CONST uint kReflectionEnvironment = 12u;
// Rays among all of these whose way the surface's own facet blocked.
VIEWLOOM_ABI_CONST uint kReflectionBent = 13u;
VIEWLOOM_ABI_CONST uint kReflectionCountsEnd = 14u;

// Fate of a ray behind the body that it passed behind first.
VIEWLOOM_ABI_CONST uint kBodyUnknown = 0u;  // none, or it is not seen from rim to rim
VIEWLOOM_ABI_CONST uint kBodyPassed = 1u;
VIEWLOOM_ABI_CONST uint kBodyMet = 2u;

// Light that comes to a pixel by way of the surface that it shows.
struct ReflectedLight {
  // Red, green and blue in binary16; how far what is mirrored lies behind the surface, m (of all
  // rays the harmonic mean), and what weight the light has among that of others, 8 bits each
  // (lib/mirrors/reflected_light.glsl).
  uvec2 light;
  // Share of the light that adds to the pixel, as square roots: 0..255 of red, green, blue;
  // roughness.
  uint reflectance;
  uint place;  // the surface's normal in 8 + 8 bits, and the upper half of its inv_z's bits
};

// Push constants of add_reflections.comp.
struct AddReflectionsPush {
  Address linear;  // vec4[rows][width] as in TraceExtras, changed too; or 0
  uint atlas_width_px;
  uint first_row;  // of the band, in the atlas
  uint row_count;
  uint tile_size_px;  // width | height << 16
  uint padding_top_px;
  uint is_filtered;
  float focal_px;  // of the views
};

// Rows that are filtered together: bands begin at multiples of so many in their image, so that no
// px depends on how an atlas was cut into bands.
VIEWLOOM_ABI_CONST uint kFilterRows = 64u;

#ifdef __cplusplus
static_assert(sizeof(ReflectionSettings) == 148);
static_assert(sizeof(ReflectedPath) == 156);
static_assert(sizeof(MergePathsPush) == 68);
static_assert(sizeof(ReflectedLight) == 16);
static_assert(sizeof(AddReflectionsPush) == 36);
#endif

VIEWLOOM_ABI_END

#endif  // VIEWLOOM_SHADERS_SHARED_REFLECTION_ABI_H_
