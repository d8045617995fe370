// SPDX-License-Identifier: Apache-2.0
// Writes PNG files.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "base/status.h"

namespace viewloom::files {

// samples: uint8_t[height_px][width_px][channels], packed, top row first; channels 1 (grey), 3
// (RGB) or 4 (RGBA). Returns the bytes of the file.
absl::StatusOr<std::string> encodePng(std::span<const uint8_t> samples, uint32_t width_px,
                                      uint32_t height_px, uint32_t channels);

// samples: uint16_t[height_px][width_px][3], RGB of 16 bits. Returns the bytes of the file.
absl::StatusOr<std::string> encodePng16(std::span<const uint16_t> samples, uint32_t width_px,
                                        uint32_t height_px);

}  // namespace viewloom::files
