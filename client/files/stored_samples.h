// SPDX-License-Identifier: Apache-2.0
// Samples of any number type and byte order, as pictures take them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "files/picture.h"

namespace viewloom::files {

enum class NumberKind { kUnsigned, kSigned, kFloat };

struct SampleType {
  NumberKind kind = NumberKind::kUnsigned;
  uint32_t bytes = 1;  // 1, 2, 4 or 8; floats 2, 4 or 8
  bool is_big_endian = false;
};

// Unsigned numbers of 8 and 16 bits stay whole; all others become binary32.
uint32_t pictureBits(const SampleType& type);

// Puts the sample that `stored` begins with at this index of a picture of pictureBits.
void storeSample(const uint8_t* stored, const SampleType& type, Picture& picture, size_t index);

}  // namespace viewloom::files
