// SPDX-License-Identifier: Apache-2.0
// Answers of several sources to a ray.
#ifndef VIEWLOOM_LIB_SOURCES_LOAD_ANSWER_GLSL_
#define VIEWLOOM_LIB_SOURCES_LOAD_ANSWER_GLSL_

#include "shared/trace_abi.h"

layout(set = 0, binding = kBindingAnswers, scalar) readonly buffer Answers {
  RayAnswer answers[];
};

// Where the answers to a ray lie.
struct Asked {
  uint source_count;
  uint stride;        // from one walk's answers to the next
  uvec2 first_walks;  // of each source, 8 bits each
  uint index;         // of the ray among those of a walk
};

// The first of those that are a source's.
uint walkOfSource(Asked asked, uint source) {
  const uint walks = source < 4u ? asked.first_walks.x : asked.first_walks.y;
  return walks >> (8u * (source & 3u)) & 255u;
}

RayAnswer loadAnswer(Asked asked, uint source) {
  return answers[walkOfSource(asked, source) * asked.stride + asked.index];
}

#endif  // VIEWLOOM_LIB_SOURCES_LOAD_ANSWER_GLSL_
