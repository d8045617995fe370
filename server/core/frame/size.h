// SPDX-License-Identifier: Apache-2.0
// A size in whole pixels.
#pragma once

#include <cstdint>

namespace viewloom {

struct SizePx {
  uint32_t width = 0;
  uint32_t height = 0;

  uint64_t area() const { return uint64_t{width} * height; }
  bool operator==(const SizePx&) const = default;
};

}  // namespace viewloom
