// SPDX-License-Identifier: Apache-2.0
#include "decode/h264_plane.h"

#include <algorithm>
#include <memory>

#include "base/str_cat.h"
#include "video/openh264_decoder.h"
#include "video/still_pictures.h"
#include "video/view_colors.h"

namespace viewloom {
namespace {

constexpr size_t kOpaqueBytes = 4;

}  // namespace

absl::Status decodeH264Plane(std::span<const uint8_t> wire, SizePx size_px,
                             std::vector<uint8_t>& out) {
  const absl::StatusOr<std::vector<StillPicture>> pictures = stillPicturesOf(wire, size_px);
  VIEWLOOM_RETURN_IF_ERROR(pictures.status());
  const absl::StatusOr<std::unique_ptr<OpenH264Decoder>> decoder = OpenH264Decoder::make();
  VIEWLOOM_RETURN_IF_ERROR(decoder.status());
  const size_t row_bytes = size_px.width * kOpaqueBytes;
  out.resize(size_px.height * row_bytes);
  uint32_t row = 0;
  for (const StillPicture& still : *pictures) {
    const auto picture = (*decoder)->decode(still.access_unit, still.size_px);
    if (absl::IsResourceExhausted(picture.status())) return picture.status();
    if (!picture.ok()) {
      return absl::InvalidArgumentError(strCat("the picture at row ", row,
                                               " does not decode: ", picture.status().message(),
                                               "; send it whole and unchanged"));
    }
    const uint32_t row_count = std::min(still.size_px.height, size_px.height - row);
    writeOpaqueColors(*picture, {.view_px = {size_px.width, row_count}},
                      out.data() + row * row_bytes, row_bytes);
    row += row_count;
  }
  return absl::OkStatus();
}

}  // namespace viewloom
