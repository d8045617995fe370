// SPDX-License-Identifier: Apache-2.0
// The columns of a source in host memory: inv_z of every layer, in canonical form.
#pragma once

#include <array>
#include <cstdint>

#include "frame/depth.h"
#include "frame/frame.h"
#include "shared/structure_abi.h"
#include "sweep/aligned_array.h"
#include "sweep/surface_row.h"

namespace viewloom {

// Vectors may be loaded from any column of the image, and up to so many columns before it and so
// many rows above or below it: there is no surface in the guard around the image.
inline constexpr uint32_t kGuardColumns = 64;
inline constexpr uint32_t kGuardRows = 4;

// Found in some rows, and added up.
struct ColumnCounts {
  uint64_t bad_samples_count = 0;
  uint64_t unsorted_columns_count = 0;
  float inv_z_min = 3.4e38F;  // of the surfaces, 1/m; above the largest without any
  float inv_z_max = abi::kNoSurface;

  void add(const ColumnCounts& other);
};

// How coarse columns are smoothed (shaders/structure.md, Coarse depth).
struct Smoothing {
  float reach = 0;  // 1/m; 0 = not at all
  uint32_t first_pass = 0;
};

// float inv_z[layer][row][column], 1/m, nearest layer first, abi::kNoSurface where there is none:
// what prepare_columns.comp makes (shaders/structure.md, Source).
// Thread-safety: rows may be prepared by several threads at a time, others than are read.
class DepthColumns {
 public:
  // Room for the first source of such frames. Reads the frame's planes later on, as long as rows
  // are prepared.
  void beginFrame(const Frame& frame);
  ColumnCounts prepareRows(uint32_t first, uint32_t count);

  // Once all rows are prepared: each pass over all rows before the next, from `first_pass` on.
  // Returns the range of what the last pass makes.
  void beginSmoothing(const Smoothing& smoothing);
  ColumnCounts smoothRows(uint32_t pass, uint32_t first, uint32_t count);

  SizePx sizePx() const { return size_px_; }
  uint32_t layerCount() const { return layer_count_; }
  // Floats from row to row.
  uint32_t pitch() const { return pitch_; }
  // From column 0 on; row -kGuardRows .. height + kGuardRows - 1.
  const float* row(uint32_t layer, int y) const { return inv_z_.data() + offset(layer, y); }
  uint64_t sizeBytes() const;
  // The same of such frames, at most: once they are smoothed.
  static uint64_t bytesFor(SizePx size_px, uint32_t layer_count);

 private:
  struct Plane {
    const std::byte* samples = nullptr;
    PlaneEncoding encoding = PlaneEncoding::kDepthF32;
    DepthCoefficients coefficients;
  };

  size_t offset(uint32_t layer, int y) const {
    return (size_t{layer} * (size_px_.height + 2 * kGuardRows) + size_t(y + int(kGuardRows))) *
               pitch_ +
           kGuardColumns;
  }
  size_t floatCount() const;
  void clearGuard(float* inv_z) const;
  // Those of all layers, of an array like inv_z_.
  template <typename Float>
  ByLayer<Float*> rowsAt(Float* inv_z, int y) const;

  SizePx size_px_;
  uint32_t layer_count_ = 0;
  uint32_t pitch_ = 0;
  AlignedArray<float> inv_z_;
  // Results of the passes of smoothing, in turn; the last pass writes inv_z_.
  std::array<AlignedArray<float>, 2> halves_;
  Smoothing smoothing_;
  std::array<Plane, abi::kLayerCountMax> planes_;
  abi::vec3 format_step_{0};
  Intrinsics intrinsics_;
};

}  // namespace viewloom
