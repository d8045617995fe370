// SPDX-License-Identifier: Apache-2.0
// What is measured on the columns of a source: its depths, steps and noise, and the connection
// tolerance that follows. The same as measure_depth.comp and settle_tolerance.comp find.
#pragma once

#include <array>

#include "frame/depth_spread.h"
#include "frame/stage_times.h"
#include "sweep/depth_columns.h"

namespace viewloom {

// kappa(a, b) = max(absolute, relative max(a, b)), shaders/README.md, Links.
struct Kappa {
  float absolute = 0;  // 1/m
  float relative = 0;
};

// Of layer 0, one px of every block of 4x4.
struct ColumnHistograms {
  std::array<uint32_t, abi::kDepthHistogramBinCount> depth{};
  std::array<uint32_t, abi::kNoiseHistogramBinCount> noise{};  // |second differences|

  // Needs rows 4 block_row + 1 .. 4 block_row + 3 prepared, of those in the image.
  void addBlockRow(const DepthColumns& columns, uint32_t block_row);
  void add(const ColumnHistograms& other);
};

struct MeasuredColumns {
  SourceStats stats;
  DepthSpread depths;  // of layer 0
  Kappa kappa;
  Smoothing smoothing;
};

// `given_kappa`: the publisher's connection tolerance, 1/m; 0 = measured.
MeasuredColumns settleColumns(const ColumnHistograms& histograms, const ColumnCounts& counts,
                              float given_kappa);

}  // namespace viewloom
