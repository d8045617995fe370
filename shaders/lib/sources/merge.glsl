// SPDX-License-Identifier: Apache-2.0
// One answer of several: shaders/walk.md, Several sources.
#ifndef VIEWLOOM_LIB_SOURCES_MERGE_GLSL_
#define VIEWLOOM_LIB_SOURCES_MERGE_GLSL_

#include "lib/sources/load_answer.glsl"
#include "lib/fault.glsl"
#include "shared/trace_abi.h"

struct Merged {
  uint ray_class;
  float view_inv_z;  // of the hit
  vec4 light;        // codes 0..255, and 1 where it is known
  uint main_source;  // the one that counts most
  uint visits;       // of all
};

bool isHit(RayAnswer answer) {
  return answer.ray_class == kClassHit || answer.ray_class == kClassHitAssumed;
}

// The hits of two sources are one surface.
bool areOne(RayAnswer a, RayAnswer b) {
  return abs(a.view_inv_z - b.view_inv_z) <= max(a.tolerance, b.tolerance);
}

// An assumed hit lies in a stretch that the other source has seen to be free, up to its own hit.
bool isRefuted(RayAnswer assumed, RayAnswer by) {
  return assumed.ray_class == kClassHitAssumed && by.ray_class == kClassHit &&
         assumed.view_inv_z > by.view_inv_z && assumed.view_inv_z <= by.entry_inv_z &&
         !areOne(assumed, by);
}

bool isRefuted(RayAnswer answer, Asked asked) {
  bool is_refuted = false;
  uint other = 0u;
  for (;;) {
    is_refuted = is_refuted || isRefuted(answer, loadAnswer(asked, other));
    ++other;
    if (other >= asked.source_count) break;
  }
  return is_refuted;
}

// Rank of answers without a hit: how much is known of the ray's end.
uint rankOf(uint ray_class) {
  return ray_class == kClassEmpty ? 3u : ray_class == kClassHidden ? 2u : 1u;
}

// Whether an answer without a hit is the better one of two: who says more; of those that are
// hidden, who saw the ray further before it passed behind something; of those outside, who saw it
// leave last. A light that is not known is worth least.
bool saysMore(RayAnswer a, RayAnswer b) {
  const uint rank_a = rankOf(a.ray_class);
  const uint rank_b = rankOf(b.ray_class);
  const bool known_a = unpackHalf2x16(a.light.y).y > 0.5;
  const bool known_b = unpackHalf2x16(b.light.y).y > 0.5;
  const float seen_a = a.ray_class == kClassHidden ? a.passed_inv_z : a.view_inv_z;
  const float seen_b = b.ray_class == kClassHidden ? b.passed_inv_z : b.view_inv_z;
  return rank_a != rank_b ? rank_a > rank_b : known_a != known_b ? known_a : seen_a < seen_b;
}

vec4 lightOf(RayAnswer answer) {
  return vec4(unpackHalf2x16(answer.light.x), unpackHalf2x16(answer.light.y));
}

// Nobody hits.
Merged mergedEnd(Asked asked) {
  uint best = 0u;
  uint visits = 0u;
  uint source = 0u;
  for (;;) {
    const RayAnswer answer = loadAnswer(asked, source);
    visits += answer.visits;
    if (saysMore(answer, loadAnswer(asked, best))) best = source;
    ++source;
    if (source >= asked.source_count) break;
  }
  const RayAnswer answer = loadAnswer(asked, best);
  return Merged(answer.ray_class, 0.0, lightOf(answer), best, visits);
}

// The nearest of the hits that nobody refutes; of two at one place the certain one.
uint nearestHit(Asked asked) {
  uint nearest = asked.source_count;
  uint source = 0u;
  for (;;) {
    const RayAnswer answer = loadAnswer(asked, source);
    if (isHit(answer) && (hasFault(kFaultNoRefuting) || !isRefuted(answer, asked))) {
      const RayAnswer best = loadAnswer(asked, min(nearest, asked.source_count - 1u));
      const bool is_nearer = hasFault(kFaultFarthestHit) ? answer.view_inv_z < best.view_inv_z
                                                         : answer.view_inv_z > best.view_inv_z;
      const bool is_surer =
          answer.view_inv_z == best.view_inv_z && answer.ray_class < best.ray_class;
      if (nearest == asked.source_count || is_nearer || is_surer) nearest = source;
    }
    ++source;
    if (source >= asked.source_count) break;
  }
  return nearest;
}

// Hits on the same surface as the nearest one blend; if some of them are certain, those alone.
Merged mergedHit(uint nearest, Asked asked) {
  const RayAnswer near = loadAnswer(asked, nearest);
  bool is_certain = false;
  uint source = 0u;
  for (;;) {
    const RayAnswer answer = loadAnswer(asked, source);
    is_certain = is_certain || (answer.ray_class == kClassHit && areOne(answer, near));
    ++source;
    if (source >= asked.source_count) break;
  }
  const uint ray_class = is_certain ? kClassHit : kClassHitAssumed;
  Merged merged = Merged(ray_class, 0.0, vec4(0.0), nearest, 0u);
  float weight_sum = 0.0;
  float weight_max = -1.0;
  source = 0u;
  for (;;) {
    const RayAnswer answer = loadAnswer(asked, source);
    merged.visits += answer.visits;
    const bool blends = answer.ray_class == ray_class && areOne(answer, near) &&
                        !(hasFault(kFaultNoBlend) && source != nearest);
    const float given = hasFault(kFaultWeightsSwapped) ? 1.0 / answer.weight : answer.weight;
    const float weight = blends ? given : 0.0;
    // Not by weight 0: who knows nothing may say infinity.
    merged.view_inv_z += blends ? weight * answer.view_inv_z : 0.0;
    merged.light += blends ? weight * lightOf(answer) : vec4(0.0);
    weight_sum += weight;
    merged.main_source = blends && weight > weight_max ? source : merged.main_source;
    weight_max = blends ? max(weight, weight_max) : weight_max;
    ++source;
    if (source >= asked.source_count) break;
  }
  merged.view_inv_z /= weight_sum;
  merged.light /= weight_sum;
  return merged;
}

Merged mergeAnswers(Asked asked) {
  uint nearest = nearestHit(asked);
  if (hasFault(kFaultHiddenWins) && mergedEnd(asked).ray_class == kClassHidden) {
    nearest = asked.source_count;
  }
  if (nearest == asked.source_count) return mergedEnd(asked);
  return mergedHit(nearest, asked);
}

#endif  // VIEWLOOM_LIB_SOURCES_MERGE_GLSL_
