// SPDX-License-Identifier: Apache-2.0
#include "decode/arriving_plane.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "decode/rgb_to_rgba.h"
#include "frame/limits.h"
#include "frame/plane_encoding.h"

namespace viewloom {

ArrivingPlane::ArrivingPlane(const PlaneFormat& plane, BytePool& pool)
    : widens_(widensOnArrival(plane)),
      buffer_(pool.takeUncleared(widens_ ? decodedBytes(plane) : plane.wire_bytes)) {}

void ArrivingPlane::append(std::span<const uint8_t> bytes) {
  collected_bytes_ += bytes.size();
  if (widens_) return appendRgb(bytes);
  if (!bytes.empty()) std::memcpy(grow(bytes.size()), bytes.data(), bytes.size());
}

BytePool::Buffer ArrivingPlane::take() {
  buffer_->resize(filled_bytes_);
  return std::exchange(buffer_, nullptr);
}

uint8_t* ArrivingPlane::grow(size_t bytes) {
  const size_t end = filled_bytes_ + bytes;
  if (buffer_->size() < end) buffer_->resize(end);
  return buffer_->data() + std::exchange(filled_bytes_, end);
}

void ArrivingPlane::appendRgb(std::span<const uint8_t> bytes) {
  while (cut_bytes_ > 0 && !bytes.empty()) {
    cut_pixel_.at(cut_bytes_++) = bytes.front();
    bytes = bytes.subspan(1);
    if (cut_bytes_ < kRgbBytes) continue;
    widen(cut_pixel_);
    cut_bytes_ = 0;
  }
  if (bytes.empty()) return;
  cut_bytes_ = bytes.size() % kRgbBytes;
  std::ranges::copy(bytes.last(cut_bytes_), cut_pixel_.begin());
  widen(bytes.first(bytes.size() - cut_bytes_));
}

void ArrivingPlane::widen(std::span<const uint8_t> pixels) {
  widenRgb(pixels, grow(pixels.size() / kRgbBytes * 4));
}

}  // namespace viewloom
