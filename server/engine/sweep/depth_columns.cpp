// SPDX-License-Identifier: Apache-2.0
#include "sweep/depth_columns.h"

#include <algorithm>

#include "sweep/column_kernels.h"
#include "sweep/smooth_kernels.h"

namespace viewloom {
namespace {

// Rows begin at whole cache lines.
constexpr uint32_t kPitchFloats = 16;

uint32_t pitchOf(uint32_t width) {
  return (width + kPitchFloats - 1) / kPitchFloats * kPitchFloats + kGuardColumns;
}

// Behind the image a row may have been written over by whole vectors.
void endRow(float* row, uint32_t width, ColumnCounts& counts) {
  const InvZRange range = rangeOfRow(row, width);
  counts.inv_z_min = std::min(counts.inv_z_min, range.min);
  counts.inv_z_max = std::max(counts.inv_z_max, range.max);
  std::fill_n(row + width, kPitchFloats, abi::kNoSurface);
}

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
  pitch_ = pitchOf(size_px.width);
  inv_z_.reserve(floatCount());
  clearGuard(inv_z_.data());
}

size_t DepthColumns::floatCount() const {
  const size_t row_count = size_t{layer_count_} * (size_px_.height + 2 * kGuardRows);
  return row_count * pitch_ + 2 * kGuardColumns;
}

uint64_t DepthColumns::bytesFor(SizePx size_px, uint32_t layer_count) {
  constexpr uint64_t kArrays = 3;
  const uint64_t row_count = uint64_t{layer_count} * (size_px.height + 2 * kGuardRows);
  return kArrays * (row_count * pitchOf(size_px.width) + 2 * kGuardColumns) * sizeof(float);
}

uint64_t DepthColumns::sizeBytes() const {
  return inv_z_.sizeBytes() + halves_[0].sizeBytes() + halves_[1].sizeBytes();
}

// The guard behind a row is the one before the next.
void DepthColumns::clearGuard(float* inv_z) const {
  const int height = int(size_px_.height);
  for (uint32_t layer = 0; layer < layer_count_; ++layer) {
    for (int y = -int(kGuardRows); y < height + int(kGuardRows); ++y) {
      float* const begin = inv_z + offset(layer, y) - kGuardColumns;
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
    for (uint32_t i = 0; i < layer_count_; ++i) endRow(columns.layers[i], size_px_.width, counts);
  }
  return counts;
}

void DepthColumns::beginSmoothing(const Smoothing& smoothing) {
  smoothing_ = smoothing;
  for (AlignedArray<float>& half : halves_) {
    half.reserve(floatCount());
    clearGuard(half.data());
  }
}

template <typename Float>
ByLayer<Float*> DepthColumns::rowsAt(Float* inv_z, int y) const {
  // There is no surface in any row of the guard; strides are longer than it is high.
  const bool is_inside = y >= 0 && y < int(size_px_.height);
  ByLayer<Float*> rows{};
  for (uint32_t i = 0; i < layer_count_; ++i) rows[i] = inv_z + offset(i, is_inside ? y : -1);
  return rows;
}

ColumnCounts DepthColumns::smoothRows(uint32_t pass, uint32_t first, uint32_t count) {
  const bool is_first = pass == smoothing_.first_pass;
  const bool is_last = pass + 1 == abi::kSmoothingPassCount;
  const float* const from = is_first ? inv_z_.data() : halves_[(pass + 1) & 1].data();
  float* const to = is_last ? inv_z_.data() : halves_[pass & 1].data();
  const int stride = abi::smoothingStride(pass);
  ColumnCounts counts;
  for (int y = int(first); y < int(first + count); ++y) {
    const SmoothedRow row{.layer_count = layer_count_,
                          .width = size_px_.width,
                          .stride = stride,
                          .reach = smoothing_.reach,
                          .samples = rowsAt<const float>(inv_z_.data(), y),
                          .here = rowsAt(from, y),
                          .above = rowsAt(from, y - stride),
                          .below = rowsAt(from, y + stride),
                          .result = rowsAt(to, y)};
    smoothRow(row);
    for (uint32_t i = 0; i < layer_count_; ++i) endRow(row.result[i], size_px_.width, counts);
  }
  return counts;
}

}  // namespace viewloom
