// SPDX-License-Identifier: Apache-2.0
// Writes predicted planes by the letter of proto PLANE_COMPRESSION_PREDICTED_ZSTD, for tests that
// read them.
#pragma once

#include <cstdint>
#include <vector>

namespace viewloom {

// Content of the plane's zstd frame. samples: [height][width].
std::vector<uint8_t> predictedBytes(const std::vector<uint16_t>& samples, int width, int height);

// The samples as a decoded plane holds them: little endian.
std::vector<uint8_t> littleEndian(const std::vector<uint16_t>& samples);

}  // namespace viewloom
