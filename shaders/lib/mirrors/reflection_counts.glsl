// SPDX-License-Identifier: Apache-2.0
// Reflected rays by where they ended, as an invocation counts its own and a subgroup adds them up.
#ifndef VIEWLOOM_LIB_MIRRORS_REFLECTION_COUNTS_GLSL_
#define VIEWLOOM_LIB_MIRRORS_REFLECTION_COUNTS_GLSL_

#include "lib/memory.glsl"
#include "shared/reflection_abi.h"

// Two to a word: a subgroup has at most 128 lanes of 64 samples of 4 rays each.
const uint kReflectionBits = 16u;

void countReflection(inout uvec3 counts, uint ending, bool is_bent) {
  const uint place = ending - kReflectionHit;
  const uint one = 1u << (kReflectionBits * (place % 2u));
  const uint bent = is_bent ? 1u << kReflectionBits : 0u;
  counts += uvec3(place < 2u ? one : 0u, (place & ~1u) == 2u ? one : 0u,
                  (place >= 4u ? one : 0u) + bent);
}

void addReflectionCounts(uvec3 counts, UintRef counters, uint counter_set) {
  const uvec3 sums = subgroupAdd(counts);
  if (!subgroupElect()) return;
  for (uint place = 0u; place < kReflectionCountsEnd - kReflectionHit; ++place) {
    const uint sum = (sums[place / 2u] >> (kReflectionBits * (place % 2u))) & 0xffffu;
    if (sum > 0u) {
      atomicAdd(counters.at[counter_set * kCounterStride + kReflectionHit + place], sum);
    }
  }
}

#endif  // VIEWLOOM_LIB_MIRRORS_REFLECTION_COUNTS_GLSL_
