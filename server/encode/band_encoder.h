// SPDX-License-Identifier: Apache-2.0
// Packs bands as a display asked for it: one instance per encode thread.
#pragma once

#include <cstdint>
#include <memory>

#include "base/byte_pool.h"
#include "encode/band_pixels.h"

namespace viewloom {

class CompactDepthEncoder;
class JpegEncoder;
class LosslessEncoder;

// Rows of a plane that can be packed apart from others of their band: slices of a band have a
// multiple of them, and begin with one.
uint32_t leastSliceRowCount(const EncodingSpec& encoding, AtlasPlane plane);

// Keeps compressor state from band to band, so that packing touches the heap only while it warms
// up. Thread-safety: none; one thread at a time. Which instance packs which band does not change a
// byte.
class BandEncoder {
 public:
  // The bands' bytes come from `pool`, which must outlive the encoder (not the bands).
  explicit BandEncoder(BytePool& pool);
  ~BandEncoder();

  // The bands of a JPEG image, joined in order of first_row, are one baseline JPEG file. The same
  // of a slice of a band: the bytes of its slices, joined, are those of the band.
  EncodedBand encode(const BandPixels& pixels, const EncodingSpec& encoding,
                     const AtlasLayout& layout);

 private:
  std::unique_ptr<JpegEncoder> jpeg_;
  std::unique_ptr<LosslessEncoder> lossless_;
  std::unique_ptr<CompactDepthEncoder> compact_depth_;  // few displays need it
  BytePool& pool_;
};

}  // namespace viewloom
