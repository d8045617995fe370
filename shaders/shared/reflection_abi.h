// SPDX-License-Identifier: Apache-2.0
// What the kernels of reflections are told beside what every trace is, and what they hand on.
#ifndef VIEWLOOM_SHADERS_SHARED_REFLECTION_ABI_H_
#define VIEWLOOM_SHADERS_SHARED_REFLECTION_ABI_H_

#include "shared/gpu_types.h"
#include "shared/surface_abi.h"
#include "shared/trace_abi.h"

VIEWLOOM_ABI_BEGIN

VIEWLOOM_ABI_CONST uint kBindingSurface = 20u;     // texels of two uints: SurfaceTexel, all layers
VIEWLOOM_ABI_CONST uint kBindingReflection = 21u;  // uniform: ReflectionSettings
VIEWLOOM_ABI_CONST uint kBindingReflected = 22u;   // storage: ReflectedLight per px of a band

struct ReflectionSettings {
  Address surfaces[kLayerCountMax];  // SurfaceTexel of each layer
  vec3 environment;                  // linear light
  float tolerance_px;                // of the display
  uint bounce_count;                 // along one ray
  uint sample_count;                 // rays a px of a rough surface
};

// Where reflected rays ended; places in a set of the trace's counters, behind those of classes.
VIEWLOOM_ABI_CONST uint kReflectionHit = 8u;
VIEWLOOM_ABI_CONST uint kReflectionAssumed = 9u;
VIEWLOOM_ABI_CONST uint kReflectionBack = 10u;
VIEWLOOM_ABI_CONST uint kReflectionCube = 11u;
VIEWLOOM_ABI_CONST uint kReflectionEnvironment = 12u;
// Of all of these, those that the surface's own facet stood in the way of.
VIEWLOOM_ABI_CONST uint kReflectionBent = 13u;
VIEWLOOM_ABI_CONST uint kReflectionCountsEnd = 14u;

// What comes to a px by way of the surface that it shows.
struct ReflectedLight {
  uvec2 light;  // binary16: red, green, blue; how far what is mirrored lies behind the surface, m
  uint reflectance;  // of the light so much adds to the px: 0..255 of red, green, blue; roughness
  uint place;        // the surface's normal in 8 + 8 bits, and the upper half of its inv_z's bits
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
static_assert(sizeof(ReflectionSettings) == 56);
static_assert(sizeof(ReflectedLight) == 16);
static_assert(sizeof(AddReflectionsPush) == 36);
#endif

VIEWLOOM_ABI_END

#endif  // VIEWLOOM_SHADERS_SHARED_REFLECTION_ABI_H_
