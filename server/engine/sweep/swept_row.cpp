// SPDX-License-Identifier: Apache-2.0
#include "sweep/swept_row.h"

namespace viewloom {

void EdgeBlends::reserve(uint32_t blend_count) {
  at.reserve(blend_count);
  other_color.reserve(blend_count);
}

void SweptRow::reserve(uint32_t width_px, uint32_t piece_count) {
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

}  // namespace viewloom
