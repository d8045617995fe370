// SPDX-License-Identifier: Apache-2.0
#include "encode/lossless_encoder.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <new>

#include <zstd_errors.h>

#include "base/check.h"

namespace viewloom {
namespace {

// Level 1 packs a depth plane at several hundred MB/s; higher levels gain little on smooth floats.
constexpr int kZstdLevel = 1;

size_t packedSampleBytes(AtlasPlane plane) {
  switch (plane) {
    case AtlasPlane::kColor:
      return 3;
    case AtlasPlane::kDepth:
      return sizeof(float);
    case AtlasPlane::kMask:
      return 1;
    case AtlasPlane::kDepthCodes:
      return sizeof(uint16_t);
    case AtlasPlane::kRed:
    case AtlasPlane::kGreen:
    case AtlasPlane::kBlue:
      break;  // of JPEG alone
  }
  failCheck(__FILE__, __LINE__, "plane is packed without loss");
}

size_t packedRowBytes(const BandPixels& pixels) {
  return packedSampleBytes(pixels.plane) * pixels.width_px;
}

}  // namespace

LosslessEncoder::LosslessEncoder(BytePool& pool) : pool_(pool), context_(ZSTD_createCCtx()) {
  if (!context_) throw std::bad_alloc();
  VIEWLOOM_CHECK(
      !ZSTD_isError(ZSTD_CCtx_setParameter(context_.get(), ZSTD_c_compressionLevel, kZstdLevel)));
}

std::span<const uint8_t> LosslessEncoder::packedRow(const BandPixels& pixels, uint32_t row) {
  const uint8_t* samples = pixels.bytes.data() + row * pixels.stride_bytes;
  if (pixels.plane != AtlasPlane::kColor && pixels.plane != AtlasPlane::kDepthCodes) {
    return {samples, packedRowBytes(pixels)};
  }
  row_.resize(packedRowBytes(pixels));
  for (size_t x = 0; x < pixels.width_px; ++x) {
    if (pixels.plane == AtlasPlane::kColor) {
      std::copy_n(samples + 4 * x, 3, row_.data() + 3 * x);
      continue;
    }
    float inv_z = 0;
    std::memcpy(&inv_z, samples + sizeof(float) * x, sizeof(float));
    const uint32_t code = abi::depthCode(inv_z, pixels.depth_scale);
    row_[2 * x] = uint8_t(code);
    row_[2 * x + 1] = uint8_t(code >> 8);
  }
  return row_;
}

SharedBytes LosslessEncoder::encodeRaw(const BandPixels& pixels) {
  BytePool::Buffer bytes = pool_.take(packedRowBytes(pixels) * pixels.row_count);
  for (uint32_t row = 0; row < pixels.row_count; ++row) {
    const std::span<const uint8_t> packed = packedRow(pixels, row);
    bytes->insert(bytes->end(), packed.begin(), packed.end());
  }
  return bytes;
}

SharedBytes LosslessEncoder::encodeZstd(const BandPixels& pixels) {
  const size_t content_bytes = packedRowBytes(pixels) * pixels.row_count;
  packed_.resize(std::max(packed_.size(), ZSTD_compressBound(content_bytes)));
  ZSTD_CCtx_reset(context_.get(), ZSTD_reset_session_only);
  VIEWLOOM_CHECK(!ZSTD_isError(ZSTD_CCtx_setPledgedSrcSize(context_.get(), content_bytes)));
  ZSTD_outBuffer out = {.dst = packed_.data(), .size = packed_.size(), .pos = 0};
  for (uint32_t row = 0; row < pixels.row_count; ++row) {
    const std::span<const uint8_t> packed = packedRow(pixels, row);
    const bool is_last = row + 1 == pixels.row_count;
    ZSTD_inBuffer in = {.src = packed.data(), .size = packed.size(), .pos = 0};
    const size_t left =
        ZSTD_compressStream2(context_.get(), &out, &in, is_last ? ZSTD_e_end : ZSTD_e_continue);
    if (ZSTD_getErrorCode(left) == ZSTD_error_memory_allocation) throw std::bad_alloc();
    VIEWLOOM_CHECK(!ZSTD_isError(left));
    VIEWLOOM_CHECK(in.pos == in.size && (!is_last || left == 0));  // `out` holds any outcome
  }
  // Sizes vary from frame to frame; powers of two let the pool's buffers settle after a few.
  BytePool::Buffer bytes = pool_.take(std::bit_ceil(out.pos));
  bytes->assign(packed_.data(), packed_.data() + out.pos);
  return bytes;
}

}  // namespace viewloom
