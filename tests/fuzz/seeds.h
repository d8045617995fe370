// SPDX-License-Identifier: Apache-2.0
// Good bytes for each of fuzz_decode.h, from which a search starts.
#pragma once

#include <cstdint>
#include <vector>

namespace viewloom {

using SeedBytes = std::vector<std::vector<uint8_t>>;

SeedBytes jpegSeeds();
SeedBytes zstdSeeds();
SeedBytes predictedSeeds();
SeedBytes frameSeeds();
SeedBytes pictureSeeds();

}  // namespace viewloom
