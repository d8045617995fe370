// SPDX-License-Identifier: Apache-2.0
// Links of a row of facets, a byte each (sweep/link_kernels.h).
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>

#include "shared/structure_abi.h"

namespace viewloom {

// The first of the bytes from `first` on that is not `value`; `end` if there is none before.
inline uint32_t findOther(const uint8_t* bytes, uint32_t first, uint32_t end, uint8_t value) {
  const uint64_t pattern = 0x0101010101010101U * value;
  for (uint32_t x = first; x < end; x += 8) {
    uint64_t word = 0;
    std::memcpy(&word, bytes + x, sizeof word);
    word ^= pattern;
    if (word != 0) return std::min(x + uint32_t(std::countr_zero(word)) / 8, end);
  }
  return end;
}

inline bool isSilhouette(uint8_t link) {
  return link == 0 || link == abi::kDeepEdge;
}

}  // namespace viewloom
