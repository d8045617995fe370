// SPDX-License-Identifier: Apache-2.0
// Rays by class, as an invocation counts its own and a subgroup adds them up.
#ifndef VIEWLOOM_LIB_WALK_CLASS_COUNTS_GLSL_
#define VIEWLOOM_LIB_WALK_CLASS_COUNTS_GLSL_

#include "lib/memory.glsl"
#include "shared/trace_abi.h"

// Two to a word: a subgroup has at most 128 lanes of 32 rays each.
const uint kCountBits = 16u;

void count(inout uvec3 counts, uint ray_class) {
  const uint place = ray_class - kClassHit;
  const uint one = 1u << (kCountBits * (place % 2u));
  counts += uvec3(place < 2u ? one : 0u, (place & ~1u) == 2u ? one : 0u, place >= 4u ? one : 0u);
}

uint countOf(uvec3 counts, uint ray_class) {
  const uint place = ray_class - kClassHit;
  return (counts[place / 2u] >> (kCountBits * (place % 2u))) & ((1u << kCountBits) - 1u);
}

// Adds up those of a subgroup: one atomic instruction for all classes, a lane each.
void addCounts(uvec3 counts, UintRef counters, uint counter_set) {
  const uvec3 sums = subgroupAdd(counts);
  uint ray_class = kClassHit + gl_SubgroupInvocationID;
  do {
    const uint sum = ray_class < kClassCount ? countOf(sums, ray_class) : 0u;
    if (sum > 0u) atomicAdd(counters.at[counter_set * kCounterStride + ray_class], sum);
    ray_class += gl_SubgroupSize;
  } while (ray_class < kClassCount);
}

#endif  // VIEWLOOM_LIB_WALK_CLASS_COUNTS_GLSL_
