// SPDX-License-Identifier: Apache-2.0
#include "video/view_format.h"

#include <algorithm>

namespace viewloom {
namespace {

// Rows of a slice. Each slice predicts anew, which costs less than 1 % of the bytes.
constexpr uint32_t kSliceRows_px = 256;
constexpr uint32_t kSlicesMax = 16;

}  // namespace

VideoFormat viewFormat(SizePx picture_px, uint32_t qp) {
  return {.size_px = picture_px,
          .qp = qp,
          .slice_count = std::clamp(picture_px.height / kSliceRows_px, 1U, kSlicesMax),
          .entropy = EntropyCoding::kVariableLength};
}

}  // namespace viewloom
