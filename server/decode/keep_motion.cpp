// SPDX-License-Identifier: Apache-2.0
#include "decode/keep_motion.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace viewloom {
namespace {

constexpr size_t kVectorBytes = 6;  // 3 binary16

struct Halves {
  uint16_t at[3];

  // All exponent bits: infinity or NaN.
  bool isBad() const {
    return std::any_of(at, at + 3, [](uint16_t half) { return (half & 0x7c00) == 0x7c00; });
  }
  bool moves() const {
    return std::any_of(at, at + 3, [](uint16_t half) { return (half & 0x7fff) != 0; });
  }
};

Halves vectorAt(const std::vector<uint8_t>& plane, size_t offset) {
  Halves halves;
  std::memcpy(halves.at, plane.data() + offset, kVectorBytes);
  return halves;
}

}  // namespace

void keepMotion(SharedBytes plane, BytePool& pool, LayerPlanes& to) {
  bool moves = false;
  to.bad_motions_count = 0;
  for (size_t offset = 0; offset < plane->size(); offset += kVectorBytes) {
    const Halves vector = vectorAt(*plane, offset);
    const bool is_bad = vector.isBad();
    to.bad_motions_count += is_bad ? 1 : 0;
    moves = moves || (!is_bad && vector.moves());
  }
  to.motion = nullptr;
  if (!moves) return;
  if (to.bad_motions_count > 0) {
    BytePool::Buffer cleaned = pool.take(plane->size());
    *cleaned = *plane;
    for (size_t offset = 0; offset < cleaned->size(); offset += kVectorBytes) {
      if (vectorAt(*cleaned, offset).isBad()) {
        std::fill_n(cleaned->begin() + std::ptrdiff_t(offset), kVectorBytes, uint8_t{0});
      }
    }
    plane = std::move(cleaned);
  }
  to.motion = std::move(plane);
}

}  // namespace viewloom
