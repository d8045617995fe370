// SPDX-License-Identifier: Apache-2.0
#include "retime/surface_links.h"

#include <algorithm>

#include "retime/quad_kernels.h"
#include "sweep/link_kernels.h"
#include "sweep/row_source.h"

namespace viewloom {
namespace {

template <typename T>
ByLayer<T*> rowsOf(ByLayer<AlignedArray<T>>& arrays) {
  ByLayer<T*> rows{};
  for (size_t i = 0; i < arrays.size(); ++i) rows[i] = arrays[i].data();
  return rows;
}

}  // namespace

SurfaceLinks::Scratch::Scratch(uint32_t width, uint32_t layer_count) {
  for (uint32_t i = 0; i < layer_count; ++i) {
    for (auto* values : {&slope_x, &slope_y, &slope_y_below}) {
      (*values)[i].reserve(width + kRowSlack);
    }
    for (auto* values : {&to_right, &to_left, &to_below, &to_above}) {
      (*values)[i].reserve(width + kRowSlack);
    }
  }
}

std::vector<SurfaceLinks::Scratch> SurfaceLinks::begin(const DepthColumns& held,
                                                       const SurfaceSteps& steps,
                                                       uint32_t worker_count) {
  held_ = &held;
  steps_ = steps;
  if (size_px_ != held.sizePx() || layer_count_ != held.layerCount()) {
    size_px_ = held.sizePx();
    layer_count_ = held.layerCount();
    const size_t count = size_px_.area() * layer_count_ + kRowSlack;
    for (auto* values : {&to_right_, &to_below_, &quads_}) {
      values->reserve(count);
      std::fill_n(values->data(), count, uint8_t{0});
    }
  }
  std::vector<Scratch> scratch;
  for (uint32_t worker = 0; worker < worker_count; ++worker) {
    scratch.emplace_back(size_px_.width, layer_count_);
  }
  return scratch;
}

void SurfaceLinks::linkRow(int y, Scratch& scratch) {
  const uint32_t width = size_px_.width;
  const auto facets = [&](const FiveRows& rows, ByLayer<AlignedArray<float>>& slopes) {
    FacetRow row{.inv_z = rows.inv_z[2], .slope = {}, .layer_count = layer_count_, .width = width};
    for (uint32_t i = 0; i < layer_count_; ++i) row.slope[i] = slopes[i].data();
    return row;
  };
  const FiveRows here = rowsAround(*held_, y);
  findSlopesX(here, rowsOf(scratch.slope_x));
  linkColumns(facets(here, scratch.slope_x), steps_, rowsOf(scratch.to_right),
              rowsOf(scratch.to_left));
  const bool has_below = y + 1 < int(size_px_.height);
  if (has_below) {
    const FiveRows below = rowsAround(*held_, y + 1);
    findSlopesY(here, rowsOf(scratch.slope_y));
    findSlopesY(below, rowsOf(scratch.slope_y_below));
    linkRows(facets(here, scratch.slope_y), facets(below, scratch.slope_y_below), steps_,
             rowsOf(scratch.to_below), rowsOf(scratch.to_above));
  }
  for (uint32_t i = 0; i < layer_count_; ++i) {
    const uint32_t first = sampleAt(i, uint32_t(y));
    std::copy_n(scratch.to_right[i].data(), width, &to_right_[first]);
    if (has_below) std::copy_n(scratch.to_below[i].data(), width, &to_below_[first]);
  }
}

void SurfaceLinks::quadRow(uint32_t y, const Columns& columns) {
  if (columns.isEmpty()) return;
  LinkedRows rows{.layer_count = layer_count_};
  ByLayer<QuadLayers*> quads{};
  for (uint32_t layer = 0; layer < layer_count_; ++layer) {
    const uint32_t row = sampleAt(layer, y);
    rows.to_right[layer] = to_right_.data() + row;
    rows.to_below[layer] = to_below_.data() + row;
    rows.to_right_below[layer] = to_right_.data() + row + size_px_.width;
    quads[layer] = quads_.data() + row;
  }
  findQuads(rows, columns.first, columns.end, quads);
}

std::optional<uint32_t> SurfaceLinks::joinedBehind(uint32_t px, uint32_t other) const {
  const uint32_t second = std::max(px, other);
  const uint8_t* const links = areInRow(px, other) ? to_right_.data() : to_below_.data();
  const auto px_count = uint32_t(size_px_.area());
  for (uint32_t layer = 1; layer < layer_count_; ++layer) {
    const uint32_t sample = layer * px_count + px;
    const bool is_joined =
        px == second ? links[other] == layer + 1 : links[sample] == 1 && links[px] != 1;
    if (is_joined && held_->row(layer, int(px / size_px_.width))[px % size_px_.width] >= 0) {
      return sample;
    }
  }
  return std::nullopt;
}

}  // namespace viewloom
