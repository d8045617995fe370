// SPDX-License-Identifier: Apache-2.0
// A TIFF file in memory, opened by libtiff.
#pragma once

#include <tiffio.h>

#include <memory>
#include <span>
#include <string>

namespace viewloom::files {

struct CloseTiff {
  void operator()(TIFF* tiff) const { TIFFClose(tiff); }
};
using TiffHandle = std::unique_ptr<TIFF, CloseTiff>;

// The bytes that libtiff reads, and what it says is wrong with them.
struct TiffStream {
  std::span<const uint8_t> bytes;
  uint64_t offset = 0;
  std::string error;  // the first one
};

// Null for what is no TIFF. `stream` outlives the handle. libtiff may take no single block of
// memory larger than `allocation_max`.
TiffHandle openTiff(TiffStream& stream, uint64_t allocation_max);

}  // namespace viewloom::files
