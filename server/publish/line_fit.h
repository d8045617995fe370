// SPDX-License-Identifier: Apache-2.0
// How a rung of quality suits the line of one reader.
#pragma once

#include <cstdint>
#include <optional>

namespace viewloom {

// Measured at the reader's socket (reader_link.h).
struct LineSpeed {
  std::optional<double> bytes_per_second;  // none = nothing shows a limit
  uint64_t recent_bytes = 0;               // that went out in the last second
};

enum class LineFit : uint8_t {
  kFar,      // the line takes less than every other atlas, and a coarser rung would help
  kNear,     // it takes most atlases, but not with room to spare; or no frames come
  kUnknown,  // it shows no limit, and has not been given nearly as much
  kFits,     // it takes all atlases, with room to spare
};

}  // namespace viewloom
