// SPDX-License-Identifier: Apache-2.0
// A row of a view, and what a sweep finds for it.
#pragma once

#include <cstdint>

#include "sweep/surface_row.h"

namespace viewloom {

// Px p of a row of a view sees, at inv_z w, the source at startAt(p) + eyeAt(p) w, which grows with
// p at every w of the source.
struct SweepView {
  float start_px = 0;
  float step_px = 1;  // > 0
  float eye_px_m = 0;
  // Step between eyes of neighbouring pixels, all of them on one side of the source.
  float eye_step_px_m = 0;
  // Or from two places, on one side too: px from this one on start so much further, and their eye
  // is so far beside that of the others. 0: no px.
  float jump_px = 0;
  float jump_start_px = 0;
  float jump_eye_px_m = 0;

  bool jumps() const { return jump_px > 0; }
  bool hasOneEye() const { return eye_step_px_m == 0 && !jumps(); }
  bool isBeyondJump(float p) const { return jumps() && p >= jump_px; }
  float startAt(float p) const {
    return start_px + step_px * p + (isBeyondJump(p) ? jump_start_px : 0);
  }
  float eyeAt(float p) const {
    return eye_px_m + eye_step_px_m * p + (isBeyondJump(p) ? jump_eye_px_m : 0);
  }
  float placeAt(float p, float inv_z) const { return startAt(p) + eyeAt(p) * inv_z; }
};

// A px that the surface of the px beside it covers in part, or the other way round.
struct EdgeBlend {
  int32_t px;
  int32_t other;
  float share;  // of the other's colour, 0..0.5
};

struct EdgeBlends {
  uint32_t count = 0;
  AlignedArray<EdgeBlend> at;
  AlignedArray<uint32_t> other_color;

  void reserve(uint32_t blend_count) {
    at.reserve(blend_count);
    other_color.reserve(blend_count);
  }
  void add(const EdgeBlend& blend) { at[count++] = blend; }
};

// One row of a view on its way, and what came of it. Thread-safety: none; one a thread.
struct SweptRow {
  // By px.
  AlignedArray<float> inv_z;  // of the hit; negative without one
  // Where the ray first passed behind the layer, after those before it; else negative.
  ByLayer<AlignedArray<float>> passed_inv_z;
  // Where it met the far side of the layer, behind which nothing of it is hit; else negative.
  ByLayer<AlignedArray<float>> met_inv_z;
  ByLayer<AlignedArray<uint64_t>> passed_vectors;  // a bit for each vector in which rays pass
  bool has_passed = false;                         // else these say nothing
  uint32_t passed_layer_count = 0;                 // of which they say something
  AlignedArray<int32_t> texel;                     // 1/256 px; -1 = the background
  AlignedArray<uint8_t> class_of_hole;             // abi::kClass..., where there is no hit
  AlignedArray<float> fill_rank;                   // the larger, the better the far side
  AlignedArray<int32_t> fill_texel;
  AlignedArray<uint8_t> block_has_hole;
  EdgeBlends blends;
  // Where these are few: where rays are at inv_z 0, and how they go on from there.
  AlignedArray<float> start_px, eye_px_m, per_eye_m_px;
  // By run, bridge or silhouette.
  AlignedArray<int32_t> from;
  AlignedArray<int32_t> to;
  AlignedArray<int32_t> covering;  // indices of those that cover px
  uint32_t covering_count = 0;
  AlignedArray<float> inv_z_at, inv_z_step, texel_at, texel_step;

  // `piece_count`: runs, or steps, of a row of the source.
  void reserve(uint32_t width_px, uint32_t piece_count) {
    constexpr uint32_t kSlack = 64;  // what vectors write beyond the last
    for (auto* values : {&inv_z, &fill_rank, &start_px, &eye_px_m, &per_eye_m_px}) {
      values->reserve(width_px + kSlack);
    }
    for (auto* layers : {&passed_inv_z, &met_inv_z}) {
      for (AlignedArray<float>& values : *layers) values.reserve(width_px + kSlack);
    }
    for (auto* values : {&texel, &fill_texel}) values->reserve(width_px + kSlack);
    for (auto* values : {&class_of_hole, &block_has_hole}) values->reserve(width_px + kSlack);
    // A surface ends once to each side of a px.
    blends.reserve(2 * width_px);
    for (AlignedArray<uint64_t>& marks : passed_vectors) marks.reserve(width_px / 64 + kSlack);
    for (auto* values : {&from, &to, &covering}) values->reserve(piece_count + kSlack);
    for (auto* values : {&inv_z_at, &inv_z_step, &texel_at, &texel_step}) {
      values->reserve(piece_count + kSlack);
    }
  }
};

}  // namespace viewloom
