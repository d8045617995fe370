// SPDX-License-Identifier: Apache-2.0
// Rewrites the boxes of HEIF files (ISO/IEC 14496-12, 23008-12), which libheif does not write for
// auxiliary images.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace viewloom::test {

using Bytes = std::vector<uint8_t>;

struct AuxiliaryImage {
  uint32_t item = 0;
  uint32_t of_item = 0;
  std::string type;  // as auxC has it
  Bytes subtypes;    // behind the type
};

// The file with a reference auxl from one image to the other, and the property auxC.
Bytes withAuxiliary(const Bytes& file, const AuxiliaryImage& auxiliary);

// The file, the size in whose n-th ispe is another: what that image says of itself is wrong.
Bytes withSizeStated(const Bytes& file, size_t n, uint32_t width_px, uint32_t height_px);

}  // namespace viewloom::test
