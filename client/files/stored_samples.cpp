// SPDX-License-Identifier: Apache-2.0
#include "files/stored_samples.h"

#include <Imath/half.h>

#include <bit>
#include <cstring>

namespace viewloom::files {
namespace {

uint64_t bitsOf(const uint8_t* stored, const SampleType& type) {
  uint64_t bits = 0;
  for (size_t i = 0; i < type.bytes; ++i) {
    bits = bits << 8 | stored[type.is_big_endian ? i : type.bytes - 1 - i];
  }
  return bits;
}

float valueOf(uint64_t bits, const SampleType& type) {
  if (type.kind == NumberKind::kFloat) {
    if (type.bytes == 2) return Imath::half(Imath::half::FromBits, static_cast<uint16_t>(bits));
    if (type.bytes == 4) return std::bit_cast<float>(static_cast<uint32_t>(bits));
    return static_cast<float>(std::bit_cast<double>(bits));
  }
  if (type.kind == NumberKind::kUnsigned) return static_cast<float>(bits);
  const uint32_t unused = 64 - 8 * type.bytes;
  return static_cast<float>(static_cast<int64_t>(bits << unused) >> unused);
}

}  // namespace

uint32_t pictureBits(const SampleType& type) {
  return type.kind == NumberKind::kUnsigned && type.bytes <= 2 ? 8 * type.bytes : 32;
}

void storeSample(const uint8_t* stored, const SampleType& type, Picture& picture, size_t index) {
  const uint64_t bits = bitsOf(stored, type);
  if (picture.bits == 8) {
    picture.bytes[index] = static_cast<uint8_t>(bits);
  } else if (picture.bits == 16) {
    const auto code = static_cast<uint16_t>(bits);
    std::memcpy(&picture.bytes[2 * index], &code, sizeof(code));
  } else {
    const float value = valueOf(bits, type);
    std::memcpy(&picture.bytes[4 * index], &value, sizeof(value));
  }
}

}  // namespace viewloom::files
