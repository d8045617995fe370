// SPDX-License-Identifier: Apache-2.0
// The compressions of deep OpenEXR chunks.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "files/exr_header.h"

namespace viewloom::files {

// Fills `unpacked` with exactly unpacked_size bytes. "" = done; else what is wrong with `packed`.
// No memory is taken for more than the compression could give from so few bytes.
std::string unpackExr(ExrCompression compression, std::span<const uint8_t> packed,
                      uint64_t unpacked_size, std::vector<uint8_t>& unpacked);

}  // namespace viewloom::files
