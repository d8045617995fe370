// SPDX-License-Identifier: Apache-2.0
#include "sweep/depth_columns.h"

#include <algorithm>

#include "sweep/column_kernels.h"

namespace viewloom {
namespace {

// Rows begin at whole cache lines.
constexpr uint32_t kPitchFloats = 16;

}  // namespace

void ColumnCounts::add(const ColumnCounts& other) {
  bad_samples_count += other.bad_samples_count;
  unsorted_columns_count += other.unsorted_columns_count;
  inv_z_min = std::min(inv_z_min, other.inv_z_min);
  inv_z_max = std::max(inv_z_max, other.inv_z_max);
}

void DepthColumns::beginFrame(const Frame& frame) {
  const SourceFormat& source = frame.format.sources.front();
  const SizePx size_px = source.layers.front().depth.size_px;
  const uint32_t layer_count = uint32_t(source.layers.size());
  intrinsics_ = source.camera.intrinsics;
  format_step_ = {};
  for (uint32_t i = 0; i < layer_count; ++i) {
    const PlaneFormat& depth = source.layers[i].depth;
    planes_[i] = {
        .samples = reinterpret_cast<const std::byte*>(frame.sources.front()[i].depth->data()),
        .encoding = depth.encoding,
        .coefficients = makeDepthCoefficients(depth.depth, depth.encoding)};
    format_step_ = glm::max(format_step_, surfaceStep(depth));
  }
  if (size_px == size_px_ && layer_count == layer_count_) return;
  size_px_ = size_px;
  layer_count_ = layer_count;
  pitch_ = (size_px.width + kPitchFloats - 1) / kPitchFloats * kPitchFloats + kGuardColumns;
  const size_t row_count = size_t{layer_count} * (size_px.height + 2 * kGuardRows);
  inv_z_.reserve(row_count * pitch_ + 2 * kGuardColumns);
  clearGuard();
}

// The guard behind a row is the one before the next.
void DepthColumns::clearGuard() {
  const int height = int(size_px_.height);
  for (uint32_t layer = 0; layer < layer_count_; ++layer) {
    for (int y = -int(kGuardRows); y < height + int(kGuardRows); ++y) {
      float* const begin = inv_z_.data() + offset(layer, y) - kGuardColumns;
      const bool is_row = y >= 0 && y < height;
      std::fill_n(begin, is_row ? kGuardColumns : pitch_ + kGuardColumns, abi::kNoSurface);
    }
  }
}

ColumnCounts DepthColumns::prepareRows(uint32_t first, uint32_t count) {
  ColumnCounts counts;
  for (uint32_t y = first; y < first + count; ++y) {
    ColumnRow columns{
        .layer_count = layer_count_, .width = size_px_.width, .format_step = format_step_};
    for (uint32_t i = 0; i < layer_count_; ++i) {
      const Plane& plane = planes_[i];
      const size_t sample_bytes = plane.encoding == PlaneEncoding::kDepthF32 ? 4 : 2;
      columns.layers[i] = inv_z_.data() + offset(i, int(y));
      counts.bad_samples_count +=
          linearizeRow({.samples = plane.samples + size_t{y} * size_px_.width * sample_bytes,
                        .encoding = plane.encoding,
                        .coefficients = &plane.coefficients,
                        .width = size_px_.width,
                        .intrinsics = intrinsics_,
                        .y = y},
                       columns.layers[i]);
    }
    counts.unsorted_columns_count += sortColumns(columns);
    for (uint32_t i = 0; i < layer_count_; ++i) {
      const InvZRange range = rangeOfRow(columns.layers[i], size_px_.width);
      counts.inv_z_min = std::min(counts.inv_z_min, range.min);
      counts.inv_z_max = std::max(counts.inv_z_max, range.max);
      std::fill_n(columns.layers[i] + size_px_.width, kPitchFloats, abi::kNoSurface);
    }
  }
  return counts;
}

}  // namespace viewloom
