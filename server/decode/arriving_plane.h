// SPDX-License-Identifier: Apache-2.0
// A plane while its bytes come.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "base/byte_pool.h"
#include "frame/frame.h"

namespace viewloom {

// Keeps bytes as they are on the wire, or as RGBA8 where widensOnArrival() says so
// (frame/plane_encoding.h): then nobody has to go over the plane again. Thread-safety: none.
class ArrivingPlane {
 public:
  // Expects a plane that validateFrame accepts.
  ArrivingPlane(const PlaneFormat& plane, BytePool& pool);

  // Bytes of the wire so far.
  uint64_t collectedBytes() const { return collected_bytes_; }
  // The next bytes, cut anywhere. Together they are at most plane.wire_bytes.
  void append(std::span<const uint8_t> bytes);
  // All that has come. Call once.
  BytePool::Buffer take();

 private:
  static constexpr size_t kRgbBytes = 3;

  uint8_t* grow(size_t bytes);
  void appendRgb(std::span<const uint8_t> bytes);
  void widen(std::span<const uint8_t> pixels);

  const bool widens_;
  BytePool::Buffer buffer_;  // with old bytes behind the first filled_bytes_
  size_t filled_bytes_ = 0;
  uint64_t collected_bytes_ = 0;
  std::array<uint8_t, kRgbBytes> cut_pixel_{};
  size_t cut_bytes_ = 0;  // of it that have come
};

}  // namespace viewloom
