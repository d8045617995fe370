// SPDX-License-Identifier: Apache-2.0
// The six faces of a cube map, as the kernels that fill their aprons reach them.
#ifndef VIEWLOOM_SHADERS_SHARED_CUBE_ABI_H_
#define VIEWLOOM_SHADERS_SHARED_CUBE_ABI_H_

#include "shared/gpu_types.h"
#include "shared/structure_abi.h"

VIEWLOOM_ABI_BEGIN

VIEWLOOM_ABI_CONST uint kCubeFaces = 6u;

// Directions of a face in the cube's space, of length 1: each along an axis.
struct CubeFace {
  vec3 right;
  vec3 down;
  vec3 forward;
  Address inv_z[kLayerCountMax];
  Address layers[kLayerCountMax];
  Address color[kLayerCountMax];
  Address measured;  // Measured
};

struct CubeFaceList {
  CubeFace faces[kCubeFaces];  // as in frame/cube_map.h: along x, y, z, plus before minus
  uint side_px;                // of a face without its apron
  uint layer_count;
};

// A face is asked about a ray from where it enters the face's own px, or so much before, so that no
// ray falls between two faces: much more than positions are rounded by.
VIEWLOOM_ABI_CONST float kSeamOverlap_px = 0.015625f;
// To so much beyond where it leaves them: a surface that goes on on the next face is hit by who
// would pass between what the two faces make of it. Ends before the next edge between columns by as
// much as above, so that rounding does not decide whether the ray gets to that edge.
VIEWLOOM_ABI_CONST float kSeam_px = 0.984375f;
// 2^30 / m. Places along a ray that are nearer than that are at the eye: poses that ought to cancel
// leave a few roundings, by far less than a nanometre, which do not decide in which face a ray from
// the place of the cube map begins.
VIEWLOOM_ABI_CONST float kAtEye = 1073741824.0f;
// Where a ray passes behind a surface at the very edge of a face, rounding decides whether it still
// is that face's; the next one says so as well. 1/Z, as a share of that.
VIEWLOOM_ABI_CONST float kSeamShare = 1e-4f;

// Beside the layer in a face's RayAnswer: the hit lies beyond the seam; the ray passed behind a
// silhouette.
VIEWLOOM_ABI_CONST uint kAnswerInSeam = 0x100u;
VIEWLOOM_ABI_CONST uint kAnswerPassedEdge = 0x200u;

// Push constants of join_faces.comp: in the answers to a piece of a band, those of the first face
// become those of the cube map.
struct JoinPush {
  uint answer_count;    // of each face
  uint answers_stride;  // from one walk's answers to the next
  uint first_walk;      // of the first face
  uint walked_faces;    // a bit each: the others see nothing
};

// Push constants of fill_apron.comp and color_apron.comp.
struct ApronPush {
  Address cube;  // CubeFaceList
  uint face;     // whose apron it is
  uint color_format;
};

#ifdef __cplusplus
static_assert(sizeof(CubeFace) == 44 + 3 * 8 * kLayerCountMax);
static_assert(sizeof(ApronPush) == 16);
static_assert(sizeof(JoinPush) == 16);
#endif

VIEWLOOM_ABI_END

#endif  // VIEWLOOM_SHADERS_SHARED_CUBE_ABI_H_
