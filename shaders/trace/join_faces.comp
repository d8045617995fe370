// SPDX-License-Identifier: Apache-2.0
// Makes one answer of what the faces of a cube map answered to a ray: an invocation a px.
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

#include "lib/sources/join_faces.glsl"

void main() {
  if (gl_GlobalInvocationID.x >= push.answer_count) return;
  answers[push.first_walk * push.answers_stride + gl_GlobalInvocationID.x] = joinFaces();
}
