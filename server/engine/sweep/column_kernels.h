// SPDX-License-Identifier: Apache-2.0
// Rows of depth samples to rows of canonical columns, with the vectors of the CPU it runs on.
#pragma once

#include <cstddef>
#include <cstdint>

#include "frame/depth.h"
#include "frame/frame.h"
#include "shared/structure_abi.h"

namespace viewloom {

// One row of one depth plane.
struct SampleRow {
  const std::byte* samples = nullptr;  // as `encoding` says, packed
  PlaneEncoding encoding = PlaneEncoding::kDepthF32;
  const DepthCoefficients* coefficients = nullptr;
  uint32_t width = 0;
  // Intrinsics for the rays of the row, if samples are distances along them.
  Intrinsics intrinsics;
  uint32_t y = 0;
};

// Writes inv_z[width], or abi::kNoSurface; returns how many samples are bad (frame/depth.h).
// May write up to a vector beyond the width.
uint32_t linearizeRow(const SampleRow& row, float* inv_z);

// The same columns of all layers, float[width] each, of an image row.
struct ColumnRow {
  float* layers[abi::kLayerCountMax] = {};
  uint32_t layer_count = 0;
  uint32_t width = 0;
  // Surfaces no further apart are one: step(w) = x + y w + z w^2, 1/m.
  abi::vec3 format_step{0};
};

// Brings columns to canonical form; returns how many came unsorted.
uint32_t sortColumns(const ColumnRow& row);

struct InvZRange {
  float min;  // of the surfaces; 3.4e38 without any
  float max;  // abi::kNoSurface without any
};
InvZRange rangeOfRow(const float* inv_z, uint32_t width);

}  // namespace viewloom
