// SPDX-License-Identifier: Apache-2.0
// Packs bands without loss: zstd, or the samples as they are.
#pragma once

#include <memory>
#include <vector>

#include <zstd.h>

#include "base/byte_pool.h"
#include "encode/band_pixels.h"

namespace viewloom {

// Colour becomes RGB8, depth codes u16, little endian; depth stays binary32, the mask one byte.
// Rows without gaps. Thread-safety: none; one thread at a time.
class LosslessEncoder {
 public:
  explicit LosslessEncoder(BytePool& pool);

  SharedBytes encodeRaw(const BandPixels& pixels);
  // One zstd frame that states its content size.
  SharedBytes encodeZstd(const BandPixels& pixels);

 private:
  // One row as it goes out; valid until the next call.
  std::span<const uint8_t> packedRow(const BandPixels& pixels, uint32_t row);

  struct FreeContext {
    void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
  };

  BytePool& pool_;
  std::unique_ptr<ZSTD_CCtx, FreeContext> context_;
  std::vector<uint8_t> row_;     // converted
  std::vector<uint8_t> packed_;  // ZSTD_compressBound of the largest band so far
};

}  // namespace viewloom
