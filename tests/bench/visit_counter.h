// SPDX-License-Identifier: Apache-2.0
// How much walked rays look at: what is usual, and what is slowest.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "display/atlas_layout.h"
#include "shared/trace_abi.h"

namespace viewloom::bench {

inline constexpr uint32_t kVisitBlockPx = 8;

// Nodes and facets that a ray looks at.
struct Visits {
  double mean = 0;
  uint32_t p99 = 0;
  uint32_t max = 0;
  uint64_t slowest_block_sum = 0;  // of the 8x8 px of one view that look at most
};

// Thread-safety: none.
class VisitCounter {
 public:
  explicit VisitCounter(const AtlasLayout& layout);

  // Whole rows of the atlas, from the top on.
  void addRows(std::span<const abi::RayRecord> records);
  Visits visits() const;

 private:
  void addRow(std::span<const abi::RayRecord> records);
  void noteBlocks();

  SizePx tile_px_;
  uint32_t columns_;
  uint32_t width_px_;
  uint32_t blocks_per_tile_;
  uint32_t next_row_ = 0;
  std::vector<uint64_t> rays_;       // [visits]
  std::vector<uint64_t> block_sum_;  // [column of tiles][block], of the rows of blocks at hand
  uint64_t slowest_block_sum_ = 0;
};

}  // namespace viewloom::bench
