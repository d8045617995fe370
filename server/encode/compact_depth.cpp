// SPDX-License-Identifier: Apache-2.0
#include "encode/compact_depth.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <new>
#include <utility>

#include "base/check.h"

namespace viewloom {
namespace {

static_assert(std::endian::native == std::endian::little);

// Runs of equal residuals are all that there is to find: longer matches cost four times the time
// and gain nothing.
constexpr int kLevel = 1;
constexpr int kStrategy = Z_RLE;
constexpr int kWindowBits = 15;
constexpr int kMemoryLevel = 9;

uint32_t halfOf(uint32_t side_px) {
  return (side_px + 1) / 2;
}

// Infinitely far what is no distance.
float distinct(float inv_z) {
  return std::isfinite(inv_z) && inv_z > 0 ? inv_z : 0;
}

uint16_t zigzag(uint16_t residual) {
  const auto sign = uint16_t(residual & 0x8000 ? 0xffff : 0);
  return uint16_t(uint16_t(residual << 1) ^ sign);
}

}  // namespace

CompactDepthEncoder::CompactDepthEncoder(BytePool& pool) : pool_(pool) {
  const int outcome =
      deflateInit2(&stream_, kLevel, Z_DEFLATED, kWindowBits, kMemoryLevel, kStrategy);
  if (outcome == Z_MEM_ERROR) throw std::bad_alloc();
  VIEWLOOM_CHECK(outcome == Z_OK);
}

CompactDepthEncoder::~CompactDepthEncoder() {
  deflateEnd(&stream_);
}

void CompactDepthEncoder::takeNearest(const BandPixels& pixels) {
  const uint32_t columns = halfOf(pixels.width_px);
  nearest_.assign(size_t{columns} * halfOf(pixels.row_count), 0);
  for (uint32_t row = 0; row < pixels.row_count; ++row) {
    const uint8_t* samples = pixels.bytes.data() + row * pixels.stride_bytes;
    float* nearest = &nearest_[size_t{columns} * (row / 2)];
    for (uint32_t x = 0; x < pixels.width_px; ++x) {
      float inv_z = 0;
      std::memcpy(&inv_z, samples + sizeof(float) * x, sizeof(float));
      nearest[x / 2] = std::max(nearest[x / 2], distinct(inv_z));
    }
  }
}

void CompactDepthEncoder::writeResiduals(uint32_t columns, uint32_t rows, float codes_per_inv_z) {
  const size_t count = size_t{columns} * rows;
  residuals_.resize(2 * count);
  codes_.assign(2 * size_t{columns}, 0);
  uint16_t* above = codes_.data();
  uint16_t* newest = above + columns;
  for (uint32_t row = 0; row < rows; ++row) {
    uint16_t left = 0;
    uint16_t above_left = 0;
    for (uint32_t x = 0; x < columns; ++x) {
      const size_t at = size_t{columns} * row + x;
      const auto code = uint16_t(std::lround(nearest_[at] * codes_per_inv_z));
      const uint16_t over = row == 0 ? uint16_t{0} : above[x];
      const uint16_t written = zigzag(uint16_t(code - uint16_t(left + over - above_left)));
      residuals_[at] = uint8_t(written);
      residuals_[count + at] = uint8_t(written >> 8);
      newest[x] = code;
      left = code;
      above_left = over;
    }
    std::swap(above, newest);
  }
}

SharedBytes CompactDepthEncoder::encode(const BandPixels& pixels) {
  takeNearest(pixels);
  const float nearest = *std::ranges::max_element(nearest_);
  const float step = nearest / float(kCompactDepthCodeMax);
  // Numbers that are hardly above 0 have no inverse.
  const bool is_far = step < std::numeric_limits<float>::min();
  const float written_step = is_far ? 0 : step;
  writeResiduals(halfOf(pixels.width_px), halfOf(pixels.row_count), is_far ? 0 : 1 / step);
  deflateReset(&stream_);
  const size_t bound = deflateBound(&stream_, uLong(residuals_.size()));
  packed_.resize(std::max(packed_.size(), bound));
  stream_.next_in = residuals_.data();
  stream_.avail_in = uInt(residuals_.size());
  stream_.next_out = packed_.data();
  stream_.avail_out = uInt(packed_.size());
  VIEWLOOM_CHECK(deflate(&stream_, Z_FINISH) == Z_STREAM_END);
  const size_t packed_bytes = packed_.size() - stream_.avail_out;
  // Sizes vary from frame to frame; powers of two let the pool's buffers settle after a few.
  BytePool::Buffer bytes = pool_.take(std::bit_ceil(sizeof(float) + packed_bytes));
  bytes->resize(sizeof(float));
  std::memcpy(bytes->data(), &written_step, sizeof(float));
  bytes->insert(bytes->end(), packed_.begin(), packed_.begin() + ptrdiff_t(packed_bytes));
  return bytes;
}

}  // namespace viewloom
