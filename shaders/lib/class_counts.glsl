// SPDX-License-Identifier: Apache-2.0
// Rays by class, as an invocation counts its own and a subgroup adds them up.
#ifndef VIEWLOOM_LIB_CLASS_COUNTS_GLSL_
#define VIEWLOOM_LIB_CLASS_COUNTS_GLSL_

#include "shared/trace_abi.h"

// Three to a word: a subgroup has fewer than 128 lanes of 8 rays each.
const uint kCountBits = 10u;

void count(inout uvec2 counts, uint ray_class) {
  const uint place = ray_class - kClassHit;
  const uint one = 1u << (kCountBits * (place % 3u));
  counts += place < 3u ? uvec2(one, 0u) : uvec2(0u, one);
}

uint countOf(uvec2 counts, uint ray_class) {
  const uint place = ray_class - kClassHit;
  return (counts[place / 3u] >> (kCountBits * (place % 3u))) & ((1u << kCountBits) - 1u);
}

#endif  // VIEWLOOM_LIB_CLASS_COUNTS_GLSL_
