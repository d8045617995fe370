// SPDX-License-Identifier: Apache-2.0
// The source that a kernel walks. The includer has `push`, a TracePush.
#ifndef VIEWLOOM_LIB_PUSHED_SCENE_GLSL_
#define VIEWLOOM_LIB_PUSHED_SCENE_GLSL_

#include "lib/tile_px.glsl"
#include "lib/walk.glsl"

Scene pushedScene(bool fills_border) {
  Scene scene;
  scene.layers = push.layers;
  scene.layer_count = push.layer_count;
  scene.extent = makeExtent(ivec2(sizeOf(push.source_size_px)));
  // A little in front of everything; never 0, it is a divisor.
  scene.inv_z_near =
      max(uintBitsToFloat(measured_head.inv_z_max_bits), kInvZNearMin) * kInvZNearMargin;
  scene.fills_border = fills_border;
  scene.kappa = vec2(measured_head.kappa_abs, measured_head.kappa_rel);
  return scene;
}

#endif  // VIEWLOOM_LIB_PUSHED_SCENE_GLSL_
