// SPDX-License-Identifier: Apache-2.0
// One picture of a video: the input of encoders, and the output of decoders.
#pragma once

#include <cstddef>
#include <cstdint>

#include "frame/size.h"

namespace viewloom {

// Y'CbCr 4:2:0 of full range with the weights of BT.601, as in JPEG files. Borrowed samples.
struct VideoPicture {
  SizePx size_px;               // even
  const uint8_t* y = nullptr;   // uint8_t[height][y_stride_bytes]
  const uint8_t* cb = nullptr;  // uint8_t[height / 2][chroma_stride_bytes]
  const uint8_t* cr = nullptr;  // the same
  size_t y_stride_bytes = 0;
  size_t chroma_stride_bytes = 0;
};

}  // namespace viewloom
