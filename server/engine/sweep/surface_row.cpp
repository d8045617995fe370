// SPDX-License-Identifier: Apache-2.0
#include "sweep/surface_row.h"

#include <algorithm>

#include "sweep/packed_codes.h"

namespace viewloom {
namespace {

// Elements that vectors read beyond the last.
constexpr uint32_t kSlack = 16;

}  // namespace

void Runs::reserve(uint32_t run_count) {
  for (auto* values : {&begin_px, &end_px, &begin_inv_z, &end_inv_z}) {
    values->reserve(run_count + kSlack);
  }
  texel_offset.reserve(run_count + kSlack);
}

void Steps::reserve(uint32_t step_count) {
  for (auto* values : {&edge_px, &low_inv_z, &high_inv_z}) values->reserve(step_count + kSlack);
  for (auto* values : {&texel, &near_texel}) values->reserve(step_count + kSlack);
  for (auto* values : {&texel_per_inv_z, &behind_px}) values->reserve(step_count + kSlack);
}

void Step::addTo(Steps& steps) const {
  if (!(low_inv_z < high_inv_z)) return;
  const uint32_t at = steps.count++;
  steps.edge_px[at] = edge_px;
  steps.low_inv_z[at] = low_inv_z;
  steps.high_inv_z[at] = high_inv_z;
  steps.texel[at] = texel;
  steps.texel_per_inv_z[at] = texel_per_inv_z;
  steps.near_texel[at] = near_texel;
  steps.behind_px[at] = behind_px;
}

void MixedTexels::reserve(uint32_t texel_count) {
  for (auto* values : {&index, &own, &inner}) values->reserve(texel_count);
}

void MixedTexels::add(uint32_t texel_index, uint32_t own_texel, uint32_t inner_texel) {
  if (own_texel == inner_texel) return;
  index[count] = texel_index;
  own[count] = own_texel;
  inner[count++] = inner_texel;
}

void SurfaceRow::reserve(uint32_t columns, uint32_t layers_of_each) {
  width_px = columns;
  layer_count = layers_of_each;
  // Every facet may be a surface of its own, and two runs.
  for (uint32_t i = 0; i < layer_count; ++i) {
    layers[i].runs.reserve(2 * columns);
    for (auto* steps : {&layers[i].bridges, &layers[i].silhouettes}) {
      for (Steps& one_way : *steps) one_way.reserve(2 * columns);
    }
  }
  nearest_texel.reserve(columns + kSlack);
  // Every facet may be a surface of its own, of three texels, and the near side of two silhouettes,
  // of as many.
  const size_t texel_count_max = 9 * size_t{columns} * layer_count + kSlack;
  texels.reserve(texel_count_max);
  texel_layer.reserve(texel_count_max);
  mixed.reserve(4 * columns * layer_count);
}

void SurfaceRow::clear() {
  texel_count = 0;
  mixed.count = 0;
  clean = 0;
  for (LayerSurfaces& layer : layers) {
    layer.runs.count = 0;
    for (auto* steps : {&layer.bridges, &layer.silhouettes}) {
      for (Steps& one_way : *steps) one_way.count = 0;
    }
  }
  std::fill_n(nearest_texel.data(), width_px, -1);
}

void SurfaceRow::cleanMixedTexels(float share) {
  if (share == clean) return;
  clean = share;
  for (uint32_t i = 0; i < mixed.count; ++i) {
    texels[mixed.index[i]] = blendOfCodes(mixed.own[i], mixed.inner[i], share);
  }
}

uint32_t SurfaceRow::pieceCountMax() const {
  uint32_t most = 0;
  for (const LayerSurfaces& layer : layers) {
    most = std::max(most, layer.runs.count);
    for (const auto* steps : {&layer.bridges, &layer.silhouettes}) {
      most = std::max({most, (*steps)[0].count, (*steps)[1].count});
    }
  }
  return most;
}

}  // namespace viewloom
