// SPDX-License-Identifier: Apache-2.0
// Ranges of columns of a source, and work that threads share by its rows.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>

#include "base/worker_pool.h"
#include "frame/size.h"

namespace viewloom {

// Work on rows is shared among threads in pieces of so many.
inline constexpr uint32_t kRetimedRowsPerPiece = 16;
inline uint32_t retimedPieceCount(SizePx size_px) {
  return (size_px.height + kRetimedRowsPerPiece - 1) / kRetimedRowsPerPiece;
}

// Calls work(y, worker) once for every row.
template <typename Work>
void forEachRow(SizePx size_px, WorkerPool& workers, const Work& work) {
  workers.forEach(retimedPieceCount(size_px), [&](uint32_t piece, uint32_t worker) {
    const uint32_t first = piece * kRetimedRowsPerPiece;
    const uint32_t end = std::min(first + kRetimedRowsPerPiece, size_px.height);
    for (uint32_t y = first; y < end; ++y) work(y, worker);
  });
}

struct Columns {
  uint32_t first = 0;
  uint32_t end = 0;  // as the first: none

  bool isEmpty() const { return first >= end; }
  uint32_t count() const { return end - first; }
  // The columns in both, and those between them.
  Columns with(const Columns& other) const {
    if (isEmpty()) return other;
    if (other.isEmpty()) return *this;
    return {std::min(first, other.first), std::max(end, other.end)};
  }
  // By so many columns on either side, within the width.
  Columns wider(uint32_t by, uint32_t width) const {
    if (isEmpty()) return *this;
    return {first - std::min(by, first), std::min(end + by, width)};
  }
};

}  // namespace viewloom
