// SPDX-License-Identifier: Apache-2.0
// The source that a kernel walks.
#ifndef VIEWLOOM_LIB_WALK_PUSHED_SCENE_GLSL_
#define VIEWLOOM_LIB_WALK_PUSHED_SCENE_GLSL_

#include "lib/rays/tile_px.glsl"
#include "lib/walk/walk.glsl"

// Without its colours, which addColor() adds where light is asked for.
Scene pushedScene(TracePush push, bool fills_border) {
  Scene scene;
  scene.layers = push.layers;
  scene.layer_count = push.layer_count;
  scene.extent = makeExtent(ivec2(sizeOf(push.source_size_px)));
  scene.fills_border = fills_border;
  addMeasured(scene, measured_head);
  return scene;
}

#endif  // VIEWLOOM_LIB_WALK_PUSHED_SCENE_GLSL_
