// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "base/check.h"
#include "files/jpeg_segments.h"
#include "files/netpbm_image.h"
#include "files/picture_file.h"
#include "fuzz/fuzz_decode.h"

namespace viewloom {
namespace {

using Decode = absl::StatusOr<files::Picture> (*)(const std::string&, std::span<const uint8_t>);

bool isWhole(const absl::StatusOr<files::Picture>& picture) {
  if (!picture.ok()) return false;
  VIEWLOOM_CHECK(picture->bytes.size() == picture->pixelCount() * picture->pixelBytes());
  return true;
}

// Whether the bytes have segments; all of what they name lies within them.
bool hasSegments(std::span<const uint8_t> bytes) {
  if (bytes.size() < 2 || bytes[0] != 0xFF || bytes[1] != 0xD8) return false;
  const files::JpegSegments segments = files::readJpegSegments(bytes);
  VIEWLOOM_CHECK(segments.end <= bytes.size());
  for (const auto& other : files::otherPictures(bytes, segments)) {
    VIEWLOOM_CHECK(other.data() + other.size() <= bytes.data() + bytes.size());
  }
  return segments.end > 0;
}

}  // namespace

bool fuzzPicture(std::span<const uint8_t> bytes) {
  bool is_accepted = hasSegments(bytes);
  for (const Decode decode : {&files::decodeBmp, &files::decodeDpt, &files::decodeNpy,
                              &files::decodePfm, &files::decodePnm}) {
    is_accepted |= isWhole(decode("fuzz", bytes));
  }
  return is_accepted;
}

}  // namespace viewloom
