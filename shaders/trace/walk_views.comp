// SPDX-License-Identifier: Apache-2.0
// Traces a band of an atlas: one ray per px of every view, by the walk.
//
// An invocation takes kPixelsPerInvocation neighbouring px of one view, so that they can share the
// bound where their rays may start. Neighbouring invocations are neighbouring *views* where the
// atlas has enough columns: between views a ray moves less in the source than between px.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "lib/memory.glsl"
#include "shared/trace_abi.h"

layout(local_size_x = kTraceGroupSize) in;

#include "lib/lens/hidden_px.glsl"
#include "lib/lens/traced_px.glsl"
#include "lib/light/edge_blend.glsl"
#include "lib/light/ray_light.glsl"
#include "lib/light/store_px.glsl"
#include "lib/rays/extras.glsl"
#include "lib/rays/views.glsl"
#include "lib/walk/class_counts.glsl"
#include "lib/walk/face_ray.glsl"
#include "lib/walk/pushed_scene.glsl"
#include "lib/walk/px_bits.glsl"
#include "lib/walk/ray_answer.glsl"
#include "lib/walk/unfinished_runs.glsl"
#include "lib/walk/walk_tasks.glsl"
#include "lib/walk/walk_views.glsl"

bool isOwn(Run run, uint i) {
  return i >= run.lead && i + run.trail < run.count;
}

// Few px lie at edges: they are traced once more, which costs less than to look at all. Hidden ones
// are left.
void blendEdges(Scene scene, ViewParams view, Run run, uvec2 edges, uvec2 hidden, float bound) {
  const vec3 near_eye = view.eye * scene.inv_z_near;
  const vec3 background = blendOfBackground(push.fill, kColorFormat);
  uvec2 pixels = edges | (edges << 1u) | uvec2(0u, edges.x >> 31u);
  Seen before;
  vec3 own_before = vec3(0.0);
  for (;;) {
    if (isNever(scene, 8u) || (pixels.x | pixels.y) == 0u) break;
    const uint px_index = lowestBit(pixels);
    Seen seen = tracePixel(scene, view, run, px_index, near_eye, bound, background).seen;
    const vec3 own = seen.color;
    if (px_index > 0u && isIn(edges, px_index - 1u)) {
      blendAcross(scene, before, seen, own_before, own);
      const bool stays = !isOwn(run, px_index - 1u) || isIn(hidden, px_index - 1u);
      if (!stays) storeColor(run.first_index + px_index - 1u, before);
    }
    if (isOwn(run, px_index) && !isIn(hidden, px_index)) {
      storeColor(run.first_index + px_index, seen);
    }
    before = seen;
    own_before = own;
    pixels = withoutLowestBit(pixels);
    if ((pixels.x | pixels.y) == 0u) break;
  }
}

void traceRun(Scene scene, ViewParams view, Task task, inout uvec3 counts) {
  const Run run = task.run;
  const vec3 near_eye = view.eye * scene.inv_z_near;
  const float bound = boundOfRun(scene, view, near_eye, run);
  const vec3 background = blendOfBackground(push.fill, kColorFormat);
  // Bit i: an edge may lie between px i and i + 1.
  uvec2 edges = uvec2(0u);
  uvec2 hidden = uvec2(0u);
  float inv_z_before = 0.0;
  uint i = 0u;
  for (;;) {
    if (isNever(scene, 5u)) break;
    const Traced px = tracePixel(scene, view, run, i, near_eye, bound, background);
    if (kIsOneOfSeveral) {
      const vec4 codes = vec4(codesOfBlend(px.seen.color, kColorFormat), px.is_known ? 1.0 : 0.0);
      const Places places = placesOf(px.view, px.direction, px.ray, px.walk);
      RayAnswer answer = answerOf(scene, Pinhole(extras.focal_px, extras.principal_px), px.view,
                                  px.ray, px.direction, px.walk, places, codes);
      if (kIsCubeFace) {
        markFaceAnswer(answer, px.stretch, px.walk, vec2(scene.extent.size_px));
      }
      answers[run.first_index + i] = answer;
    } else if (px.is_used && isOwn(run, i)) {
      const float inv_z =
          kShownBeside == 0u ? 0.0 : depthOf(px.walk, px.ray, px.view.eye, px.direction);
      storeShown(run.first_index + i, px.view, px.seen, inv_z);
      storeOthers(run.first_index + i, px.walk, px.is_known, px.ray, px.view.eye, px.direction);
      count(counts, classOf(px.walk));
      if (kListsHidden && endsBehind(px.walk)) {
        hidden |= bitOf(i);
        listHidden(run.first_index + i);
      }
    }
    const bool may_be_edge = !kIsOneOfSeveral && !kHasOwnEyes && i > 0u &&
                             (kShownBeside & view.shows) == 0u &&
                             mayBeEdge(scene, inv_z_before, px.seen.inv_z);
    edges |= may_be_edge ? bitOf(i - 1u) : uvec2(0u);
    inv_z_before = px.seen.inv_z;
    ++i;
    if (i == run.count) break;
  }
  blendEdges(scene, view, run, edges, hidden, bound);
  // The px at which loops were ended is wrong, or one whose edges were blended: all are walked once
  // more. But light that is summed already stays so.
  if (kListsUnfinished && !isOfUnfinished() && areLoopsOver(scene)) {
    const bool is_summed = (kWanted & kWantSum) != 0u;
    counts = is_summed ? counts : uvec3(0u);
    listUnfinished(task, is_summed ? i : 0u);
  }
}

Scene sceneOfColors() {
  Scene scene = pushedScene(push, (push.fill & kFillBorder) != 0u);
  addColor(scene, push.color, kColorFormat, kColorIsScaled);
  return scene;
}

void main() {
  if (kRaysOfHidden > 0u) {
    traceHidden(sceneOfColors());
    return;
  }
  Task task;
  if (kIsOfBlocks)
    task = taskOfBlock();
  else if (isOfUnfinished())
    task = taskOfUnfinished();
  else
    task = taskOfRun(gl_GlobalInvocationID.x, push.band_row + gl_WorkGroupID.y);
  ViewParams view = views[task.tile];

  uvec3 counts = uvec3(0u);
  if (kEyesInPlane) view.eye.z = 0.0;
  if (task.exists && view.is_used != 0u) {
    traceRun(sceneOfColors(), view, task, counts);
  }
  // All px have the rays that are counted.
  if (kIsOneOfSeveral || kIsOfBlocks) return;
  addCounts(counts, UintRef(extras.counters),
            (push.band_row + gl_WorkGroupID.y) * kCounterSets / push.row_count);
}
