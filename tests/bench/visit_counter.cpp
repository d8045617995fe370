// SPDX-License-Identifier: Apache-2.0
#include "bench/visit_counter.h"

#include <algorithm>

namespace viewloom::bench {

VisitCounter::VisitCounter(const AtlasLayout& layout)
    : tile_px_(layout.tile_size_px),
      columns_(layout.columns),
      width_px_(layout.size_px.width),
      blocks_per_tile_((tile_px_.width + kVisitBlockPx - 1) / kVisitBlockPx),
      block_sum_(size_t{columns_} * blocks_per_tile_) {}

void VisitCounter::addRows(std::span<const abi::RayRecord> records) {
  for (; !records.empty(); records = records.subspan(width_px_)) {
    addRow(records.first(width_px_));
  }
}

void VisitCounter::addRow(std::span<const abi::RayRecord> records) {
  const uint32_t row = next_row_++ % tile_px_.height;
  if (row % kVisitBlockPx == 0) noteBlocks();
  for (uint32_t column = 0; column < columns_; ++column) {
    for (uint32_t x = 0; x < tile_px_.width; ++x) {
      const uint32_t visits = records[size_t{column} * tile_px_.width + x].visits;
      if (visits >= rays_.size()) rays_.resize(visits + 1);
      ++rays_[visits];
      block_sum_[size_t{column} * blocks_per_tile_ + x / kVisitBlockPx] += visits;
    }
  }
}

void VisitCounter::noteBlocks() {
  for (uint64_t& sum : block_sum_) {
    slowest_block_sum_ = std::max(slowest_block_sum_, sum);
    sum = 0;
  }
}

Visits VisitCounter::visits() const {
  uint64_t ray_count = 0;
  double sum = 0;
  for (size_t count = 0; count < rays_.size(); ++count) {
    ray_count += rays_[count];
    sum += double(count) * double(rays_[count]);
  }
  if (ray_count == 0) return {};
  uint64_t rays_left = ray_count * 99 / 100;
  uint32_t p99 = 0;
  while (rays_left >= rays_[p99]) rays_left -= rays_[p99++];
  return {.mean = sum / double(ray_count),
          .p99 = p99,
          .max = uint32_t(rays_.size() - 1),
          .slowest_block_sum = std::max(slowest_block_sum_,
                                        *std::max_element(block_sum_.begin(), block_sum_.end()))};
}

}  // namespace viewloom::bench
