// SPDX-License-Identifier: Apache-2.0
// The marker segments of a JPEG file: where its picture ends, and what is told beside it.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace viewloom::files {

// Segments of a JPEG; absent ones are empty, 0 or false. Spans point into the bytes that were read.
struct JpegSegments {
  uint8_t frame_marker = 0;  // 0xC0 is baseline; 0 without a frame header
  uint32_t scan_count = 0;
  size_t end = 0;                 // behind the EOI marker of the first picture; 0 without one
  std::span<const uint8_t> exif;  // TIFF bytes of APP1
  std::vector<uint8_t> icc;       // APP2, put together
  std::string xmp;                // APP1
  std::string extended_xmp;       // put together
  size_t mpf_offset = 0;          // of the TIFF bytes of the multi-picture index; 0 without
  std::span<const uint8_t> mpf;
};

// Reads as far as the bytes are a JPEG.
JpegSegments readJpegSegments(std::span<const uint8_t> bytes);

// The other pictures of a multi-picture file (MPO, portrait photos), as the index says: each from
// its SOI marker. Those that do not lie within the bytes are left out.
std::vector<std::span<const uint8_t>> otherPictures(std::span<const uint8_t> bytes,
                                                    const JpegSegments& segments);

}  // namespace viewloom::files
