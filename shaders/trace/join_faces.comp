// SPDX-License-Identifier: Apache-2.0
// Makes one answer of what the faces of a cube map answered to a ray: shaders/walk.md, Cube maps.
// An invocation a px.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#include "shared/cube_abi.h"
#include "shared/trace_abi.h"

layout(local_size_x = kTraceGroupSize) in;
layout(push_constant, scalar) uniform Push {
  JoinPush push;
};
layout(set = 0, binding = kBindingAnswers, scalar) buffer Answers {
  RayAnswer answers[];
};

RayAnswer loadFace(uint face) {
  return answers[(push.first_walk + face) * push.answers_stride + gl_GlobalInvocationID.x];
}

// Where a face's stretch of the ray begins; kNeverPassed: nowhere.
float loadEntry(uint face) {
  const bool is_walked = (push.walked_faces >> face & 1u) != 0u;
  return is_walked ? loadFace(face).entry_inv_z : kNeverPassed;
}

#include "lib/fault.glsl"

const uint kNoFace = kCubeFaces;

// A face's stretch of a ray.
struct Stretch {
  uint face;  // kNoFace: there is none
  float begin_inv_z;
};

// The one that begins next.
Stretch stretchAfter(Stretch before) {
  Stretch next = Stretch(kNoFace, 0.0);
  uint face = 0u;
  for (;;) {
    const float begin = loadEntry(face);
    const bool is_after = begin < before.begin_inv_z ||
                          (begin == before.begin_inv_z && face > before.face);
    const bool is_nearer = next.face == kNoFace || begin > next.begin_inv_z;
    const bool is_next = begin != kNeverPassed && is_after && is_nearer;
    next.face = is_next ? face : next.face;
    next.begin_inv_z = is_next ? begin : next.begin_inv_z;
    ++face;
    if (face >= kCubeFaces) break;
  }
  return next;
}

bool isFaceHit(RayAnswer answer) {
  return answer.ray_class == kClassHit || answer.ray_class == kClassHitAssumed;
}

// Face after face along the ray, up to the first that hits. What was behind a surface in one of
// them hits assumed surfaces in the next; without a hit, the last face decides.
RayAnswer joinFaces() {
  Stretch stretch = stretchAfter(Stretch(kNoFace, 3.4e38));
  RayAnswer joined = loadFace(min(stretch.face, kNoFace - 1u));
  joined.ray_class = kClassEmpty;
  joined.light = uvec2(0u);
  joined.view_inv_z = kKnownNowhere;
  uint visits = 0u;
  float passed_inv_z = kNeverPassed;
  bool has_fill = false;
  bool ends = false;
  // A lane that is done keeps its state in the rounds of other lanes (shaders/README.md, Loops).
  for (;;) {
    const bool takes_part = stretch.face != kNoFace && !ends;
    const RayAnswer answer = loadFace(min(stretch.face, kNoFace - 1u));
    const Stretch next = stretchAfter(stretch);
    const RayAnswer answer_after = loadFace(min(next.face, kNoFace - 1u));
    // Beyond the seam a face knows surfaces by hearsay. What it hits there counts where the face
    // whose place that is has the ray behind something by then: a surface that goes on.
    const bool is_in_seam = (answer.layer & kAnswerInSeam) != 0u;
    const bool hits_later = !isFaceHit(answer_after) || answer_after.view_inv_z < answer.view_inv_z;
    const bool goes_on = !hasFault(kFaultSeamPassed) && hits_later &&
                         answer_after.passed_inv_z >= answer.view_inv_z;
    const bool counts = !is_in_seam || next.face == kNoFace || goes_on;
    const bool hits = isFaceHit(answer);
    const bool is_hidden = answer.ray_class == kClassHidden;
    const bool was_behind = passed_inv_z != kNeverPassed && !hasFault(kFaultSeamForgets);
    // A hidden ray shows the far side of the last silhouette that it passed since it was in front
    // of everything, on whichever face.
    const bool passed_edge = (answer.layer & kAnswerPassedEdge) != 0u;
    const bool keeps_fill = is_hidden && has_fill && !passed_edge;
    // Beyond the seam, whether it passes behind something is said by the next face.
    const bool passes = answer.passed_inv_z > next.begin_inv_z * (1.0 + kSeamShare);
    if (takes_part) {
      const uvec2 fill = joined.light;
      joined = answer;
      joined.layer |= stretch.face << kAnswerFaceShift;
      ends = hits && counts;
      joined.light = keeps_fill && !ends ? fill : answer.light;
      joined.ray_class = ends        ? (was_behind ? kClassHitAssumed : answer.ray_class)
                         : is_hidden ? kClassHidden
                                     : kClassEmpty;
      visits += answer.visits;
      has_fill = is_hidden && (has_fill || passed_edge);
      passed_inv_z = passes ? max(passed_inv_z, answer.passed_inv_z) : passed_inv_z;
      ends = ends || hasFault(kFaultFirstFaceEnds);
    }
    stretch.face = takes_part ? next.face : stretch.face;
    stretch.begin_inv_z = takes_part ? next.begin_inv_z : stretch.begin_inv_z;
    if (ends || stretch.face == kNoFace) break;
  }
  joined.visits = visits;
  joined.layer &= ~(kAnswerInSeam | kAnswerPassedEdge);
  joined.entry_inv_z = hasFault(kFaultCubeSawNothing) ? kNeverPassed : kKnownNowhere;
  joined.passed_inv_z = passed_inv_z;
  return joined;
}

void main() {
  if (gl_GlobalInvocationID.x >= push.answer_count) return;
  answers[push.first_walk * push.answers_stride + gl_GlobalInvocationID.x] = joinFaces();
}
