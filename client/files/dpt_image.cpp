// SPDX-License-Identifier: Apache-2.0
#include "files/picture_file.h"

#include <bit>

#include "files/byte_cursor.h"
#include "files/file_bytes.h"

namespace viewloom::files {
namespace {

constexpr float kTag = 202021.25F;

}  // namespace

absl::StatusOr<Picture> decodeDpt(const std::string& name, std::span<const uint8_t> bytes) {
  ByteCursor cursor(bytes);
  const auto tag = std::bit_cast<float>(cursor.take32());
  const int32_t width_px = cursor.takeSigned32(), height_px = cursor.takeSigned32();
  if (cursor.hasFailed()) return refuseCutShort(name, "DPT");
  if (tag != kTag) {
    return refuseDamaged(name, "DPT", "it does not begin with the number 202021.25");
  }
  VIEWLOOM_RETURN_IF_ERROR(checkPlaneSize(name, width_px, height_px));
  Picture picture{.width_px = static_cast<uint32_t>(width_px),
                  .height_px = static_cast<uint32_t>(height_px),
                  .channels = 1,
                  .bits = 32,
                  .coding = {},
                  .bytes = {}};
  const size_t wanted = 4 * picture.pixelCount();
  if (cursor.leftCount() == 2 * wanted) {
    return refuseFile(name, "is optical flow (FLO), two numbers a px; depth is a DPT file");
  }
  if (cursor.leftCount() < wanted) return refuseCutShort(name, "DPT");
  const auto samples = cursor.take(wanted);
  picture.bytes.assign(samples.begin(), samples.end());
  return picture;
}

}  // namespace viewloom::files
