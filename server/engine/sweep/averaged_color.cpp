// SPDX-License-Identifier: Apache-2.0
#include "sweep/averaged_color.h"

#include <algorithm>

#include "sweep/link_kernels.h"

namespace viewloom {

void AveragedColor::Layer::reserve(uint32_t width) {
  copy.reserve(width + kRowSlack);
  for (auto* slopes : {&slope_x, &slope_y}) slopes->reserve(width + kRowSlack);
  for (AlignedArray<uint8_t>& bytes : links) bytes.reserve(width + kRowSlack);
  is_mixed.reserve(width + kRowSlack);
}

void AveragedColor::begin(const RowSource& source, float reach_px) {
  source_ = source;
  reach_px_ = reach_px;
  if (!isNeeded()) return;
  width_ = source.columns->sizePx().width;
  height_ = int(source.columns->sizePx().height);
  layer_count_ = source.columns->layerCount();
  // Rows that the links around this row and the next need.
  rows_.resize(std::max(rows_.size(), size_t{2} * tapCount(reach_px) + 6));
  for (Row& row : rows_) {
    row.slopes_of = row.columns_linked_of = row.mixed_of = kNoRow;
    row.linked_above_of = row.linked_below_of = kNoRow;
    for (uint32_t i = 0; i < layer_count_; ++i) row.layers[i].reserve(width_);
  }
}

void AveragedColor::findSlopes(int y) {
  Row& row = rowAt(y);
  if (row.slopes_of == y) return;
  row.slopes_of = y;
  ByLayer<float*> slopes{};
  for (uint32_t i = 0; i < layer_count_; ++i) slopes[i] = row.layers[i].slope_y.data();
  findSlopesY(rowsAround(*source_.columns, y), slopes);
}

FacetRow AveragedColor::facetsAlongY(int y) {
  findSlopes(y);
  FacetRow facets{.inv_z = {}, .slope = {}, .layer_count = layer_count_, .width = width_};
  for (uint32_t i = 0; i < layer_count_; ++i) {
    facets.inv_z[i] = source_.columns->row(i, y);
    facets.slope[i] = rowAt(y).layers[i].slope_y.data();
  }
  return facets;
}

RowColumns AveragedColor::columnsOf(int y) {
  Row& row = rowAt(y);
  const FiveRows rows = rowsAround(*source_.columns, y);
  FacetRow facets{
      .inv_z = rows.inv_z[2], .slope = {}, .layer_count = layer_count_, .width = width_};
  ByLayer<float*> slopes{};
  ByLayer<uint8_t*> to_right{};
  ByLayer<uint8_t*> to_left{};
  RowColumns columns;
  for (uint32_t i = 0; i < layer_count_; ++i) {
    Layer& layer = row.layers[i];
    columns.slope_x[i] = facets.slope[i] = slopes[i] = layer.slope_x.data();
    columns.to_right[i] = to_right[i] = layer.links[abi::kEdgeRight].data();
    columns.to_left[i] = to_left[i] = layer.links[abi::kEdgeLeft].data();
  }
  if (row.columns_linked_of == y) return columns;
  row.columns_linked_of = y;
  findSlopesX(rows, slopes);
  linkColumns(facets, source_.steps, to_right, to_left);
  return columns;
}

void AveragedColor::linkToRowBelow(int y) {
  Row& above = rowAt(y);
  Row& below = rowAt(y + 1);
  if (above.linked_below_of == y && below.linked_above_of == y + 1) return;
  above.linked_below_of = y;
  below.linked_above_of = y + 1;
  ByLayer<uint8_t*> to_below{};
  ByLayer<uint8_t*> to_above{};
  for (uint32_t i = 0; i < layer_count_; ++i) {
    to_below[i] = above.layers[i].links[abi::kEdgeBottom].data();
    to_above[i] = below.layers[i].links[abi::kEdgeTop].data();
  }
  linkRows(facetsAlongY(y), facetsAlongY(y + 1), source_.steps, to_below, to_above);
}

void AveragedColor::markMixedOf(int y) {
  Row& row = rowAt(y);
  if (row.mixed_of == y) return;
  row.mixed_of = y;
  columnsOf(y);
  linkToRowBelow(y - 1);
  linkToRowBelow(y);
  for (uint32_t i = 0; i < layer_count_; ++i) {
    Layer& layer = row.layers[i];
    std::array<const uint8_t*, 4> links{};
    for (size_t edge = 0; edge < links.size(); ++edge) links[edge] = layer.links[edge].data();
    markMixed(links, width_, layer.is_mixed.data());
  }
}

// Side 1 is that of the other row, which lies a px further on.
void AveragedColor::findTaps(const RowBetween& between, size_t side) {
  std::vector<AverageTap>& taps = taps_[side];
  taps.clear();
  const bool has_other = between.share > 0;
  const bool is_down = (side == 1) == between.is_below;
  const uint32_t tap_count = tapCount(reach_px_) + (side == 1 && has_other ? 1 : 0);
  for (uint32_t k = 1; k <= tap_count; ++k) {
    const int step_y = is_down ? 1 : -1;
    const int y = between.y + int(k) * step_y;
    if (!isInside(y)) break;
    markMixedOf(y);
    const Row& before = rowAt(y - step_y);
    Row& row = rowAt(y);
    const uint32_t from_other = side == 1 ? k - 1 : k + 1;
    AverageTap& tap = taps.emplace_back();
    tap.weight_here = tapWeight(reach_px_, k);
    tap.weight_there = has_other ? tapWeight(reach_px_, from_other) : 0;
    for (uint32_t i = 0; i < layer_count_; ++i) {
      tap.color[i] = readableColorRow(source_, i, y, row.layers[i].copy.data());
      tap.links[i] = before.layers[i].links[is_down ? abi::kEdgeBottom : abi::kEdgeTop].data();
      tap.is_mixed[i] = row.layers[i].is_mixed.data();
    }
  }
}

void AveragedColor::blend(const RowBetween& between, const ByLayer<uint32_t*>& texels) {
  markMixedOf(between.y);
  for (size_t side = 0; side < taps_.size(); ++side) findTaps(between, side);
  AverageRow row{.layer_count = layer_count_,
                 .width = width_,
                 .weight_there = between.share > 0 ? tapWeight(reach_px_, 1) : 0,
                 .share = between.share,
                 .taps = {taps_[0], taps_[1]},
                 .means = texels};
  Row& own = rowAt(between.y);
  for (uint32_t i = 0; i < layer_count_; ++i) {
    row.inv_z[i] = source_.columns->row(i, between.y);
    row.color[i] = readableColorRow(source_, i, between.y, own.layers[i].copy.data());
    row.is_mixed[i] = own.layers[i].is_mixed.data();
  }
  averageRow(row);
}

}  // namespace viewloom
