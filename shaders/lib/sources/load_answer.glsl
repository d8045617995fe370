// SPDX-License-Identifier: Apache-2.0
// Answers of several sources to a ray. Parameters that the kernel sets: `answers`, and in `push`
// how they lie.
#ifndef VIEWLOOM_LIB_SOURCES_LOAD_ANSWER_GLSL_
#define VIEWLOOM_LIB_SOURCES_LOAD_ANSWER_GLSL_

#include "shared/trace_abi.h"

uint answer_index;  // of the first source, for this invocation's ray

// The first of those that are a source's.
uint walkOfSource(uint source) {
  const uint walks = source < 4u ? push.first_walks.x : push.first_walks.y;
  return walks >> (8u * (source & 3u)) & 255u;
}

RayAnswer loadAnswer(uint source) {
  return answers[walkOfSource(source) * push.answers_stride + answer_index];
}

#endif  // VIEWLOOM_LIB_SOURCES_LOAD_ANSWER_GLSL_
