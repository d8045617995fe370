// SPDX-License-Identifier: Apache-2.0
// Records of reflected rays for tests.
#ifndef VIEWLOOM_GPU_SHADERS_FOLLOWED_ABI_H_
#define VIEWLOOM_GPU_SHADERS_FOLLOWED_ABI_H_

#include "shared/trace_abi.h"

VIEWLOOM_ABI_BEGIN

VIEWLOOM_ABI_CONST uint kBindingFollowed = 30u;  // storage, written: FollowedRay per px

struct FollowedRay {
  uint is_traced;  // 0: the px mirrors nothing, and what follows is not told
  uint surface_layer;
  uint ray_class;  // kClass...
  uint is_back;
  uint layer;  // of the hit; as what follows
  float x_px;
  float y_px;
  float inv_z;  // 1/m
  // Where it first passed behind something; inv_z below 0: nowhere, or from its beginning.
  float passed_x_px;
  float passed_y_px;
  float passed_inv_z;
  uint body;  // what became of it behind that: kBody...; as what follows
  float body_x_px;
  float body_y_px;
  float body_inv_z;
};

#ifdef __cplusplus
static_assert(sizeof(FollowedRay) == 60);
#endif

VIEWLOOM_ABI_END

#endif  // VIEWLOOM_GPU_SHADERS_FOLLOWED_ABI_H_
