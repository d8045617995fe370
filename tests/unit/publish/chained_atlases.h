// SPDX-License-Identifier: Apache-2.0
// Whole atlases of chained video, of any size.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "encode/encoded_band.h"

namespace viewloom::test {

// `reference`: 0 = it needs no other.
inline AtlasPtr chainedAtlas(uint64_t sequence, uint64_t reference, size_t bytes = 10) {
  auto atlas = std::make_shared<EncodedAtlas>();
  atlas->sequence = sequence;
  atlas->reference_sequence = reference;
  atlas->bands.push_back({.bytes = std::make_shared<std::vector<uint8_t>>(bytes)});
  return atlas;
}

}  // namespace viewloom::test
