// SPDX-License-Identifier: Apache-2.0
// Bands of an atlas that are packed in slices, until all slices of a band are there.
#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <mutex>
#include <vector>

#include "base/byte_pool.h"

namespace viewloom {

// Thread-safety: all methods may be called from any thread.
class SlicedBands {
 public:
  struct Band {
    size_t output = 0;  // place in AtlasRun::outputs
    size_t index = 0;   // among the output's bands

    auto operator<=>(const Band&) const = default;
  };
  // One of `count` slices, from the top.
  struct Slice {
    uint32_t index = 0;
    uint32_t count = 1;
  };

  // A slice is packed; each once. With the last one returns the band's bytes, else nullptr.
  SharedBytes add(const Band& band, const Slice& slice, SharedBytes bytes, BytePool& pool);

 private:
  struct Slices {
    std::vector<SharedBytes> bytes;
    uint32_t packed_count = 0;
  };

  std::mutex mutex_;
  std::map<Band, Slices> bands_;
};

}  // namespace viewloom
