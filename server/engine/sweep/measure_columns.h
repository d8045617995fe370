// SPDX-License-Identifier: Apache-2.0
// Measurements on the columns of a source: depths, steps, noise, and the connection tolerance that
// follows. measure_depth.comp and settle_tolerance.comp find the same.
#pragma once

#include <array>

#include "frame/depth_spread.h"
#include "frame/stage_times.h"
#include "frame/surface_steps.h"
#include "sweep/depth_columns.h"

namespace viewloom {

// Histograms of layer 0, one pixel of every block of 4x4.
struct ColumnHistograms {
  std::array<uint32_t, abi::kDepthHistogramBinCount> depth{};
  std::array<uint32_t, abi::kNoiseHistogramBinCount> noise{};  // |second differences|
  // Places where depth is not the same in all three px.
  uint32_t changing_count = 0;

  // Needs rows 4 block_row + 1 .. 4 block_row + 3 prepared, of those in the image.
  void addBlockRow(const DepthColumns& columns, uint32_t block_row);
  void add(const ColumnHistograms& other);
};

// Where their percentiles lie, for a finer look.
abi::RangeBounds settleRange(const ColumnHistograms& histograms);

// Histogram of the same pixels, between the percentiles.
struct RangeHistogram {
  abi::RangeBounds bounds;
  std::array<uint32_t, abi::kRangeHistogramBinCount> counts{};

  void addBlockRow(const DepthColumns& columns, uint32_t block_row);
  void add(const RangeHistogram& other);
};

struct MeasuredColumns {
  SourceStats stats;
  DepthSpread depths;  // of layer 0
  SurfaceSteps steps;
  Smoothing smoothing;
};

// `width_px`: of the source. `given_kappa`: the publisher's connection tolerance, 1/m; 0 =
// measured.
MeasuredColumns settleColumns(const ColumnHistograms& histograms, const RangeHistogram& range,
                              const ColumnCounts& counts, uint32_t width_px, float given_kappa);

}  // namespace viewloom
