// SPDX-License-Identifier: Apache-2.0
#include "photos/jpeg_depth.h"

#include <utility>

#include "absl/strings/escaping.h"
#include "base/str_cat.h"
#include "files/exif.h"
#include "files/file_bytes.h"
#include "files/jpeg_image.h"
#include "files/png_image.h"
#include "photos/depth_xmp.h"

namespace viewloom::photos {
namespace {

std::span<const uint8_t> spanOf(const std::string& bytes) {
  return {reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()};
}

std::optional<JpegDepth> findGoogleDepth(const files::JpegSegments& segments) {
  const std::optional<GoogleDepth> xmp = parseGoogleDepth(segments.xmp, segments.extended_xmp);
  JpegDepth found;
  if (!xmp || !absl::Base64Unescape(xmp->data, &found.bytes)) return std::nullopt;
  found.is_png = found.bytes.starts_with("\x89PNG");
  found.depth.type = "GDepth";
  found.depth.origin = "XMP";
  if (xmp->format == "RangeLinear") found.depth.quantity = CodeQuantity::kDistance;
  if (!xmp->near_m || !xmp->far_m || !(*xmp->near_m > 0) || !(*xmp->far_m > *xmp->near_m)) {
    return found;
  }
  // Code 0 is Near: RangeInverse is linear in 1/Z, RangeLinear in Z.
  found.depth.ends = found.depth.quantity == CodeQuantity::kDistance
                         ? CodeEnds{*xmp->near_m, *xmp->far_m}
                         : CodeEnds{1 / *xmp->near_m, 1 / *xmp->far_m};
  return found;
}

std::optional<JpegDepth> findAuxiliaryDepth(std::span<const uint8_t> bytes,
                                            const files::JpegSegments& segments) {
  for (const auto& picture : files::otherPictures(bytes, segments)) {
    const files::JpegSegments its = files::readJpegSegments(picture);
    const DepthXmp xmp = parseDepthXmp(its.xmp);
    if (xmp.image_type != "disparity" && xmp.image_type != "depth") continue;
    JpegDepth found;
    found.depth.type = strCat("an auxiliary picture of ", xmp.image_type);
    readDepthXmp(xmp, found.depth);
    found.bytes.assign(picture.begin(), picture.end());
    return found;
  }
  return std::nullopt;
}

}  // namespace

std::optional<JpegDepth> findJpegDepth(std::span<const uint8_t> bytes,
                                       const files::JpegSegments& segments) {
  std::optional<JpegDepth> found = findGoogleDepth(segments);
  return found ? std::move(found) : findAuxiliaryDepth(bytes, segments);
}

absl::StatusOr<files::Picture> decodeJpegDepth(const std::string& name, JpegDepth& found,
                                               uint32_t orientation) {
  const auto bytes = spanOf(found.bytes);
  absl::StatusOr<files::Picture> picture =
      found.is_png ? files::decodePng(name, bytes, files::PictureUse::kDepth)
                   : files::decodeJpeg(name, bytes);
  if (!picture.ok()) return picture.status();
  // Turned already where the picture of the depth says so itself.
  const bool is_turned =
      !found.is_png && files::orientationOf(files::readJpegSegments(bytes).exif) != 1;
  if (!is_turned) picture = files::turned(*std::move(picture), orientation);
  found.depth.width_px = picture->width_px;
  found.depth.height_px = picture->height_px;
  found.depth.code_max = picture->whiteCode();
  return picture;
}

}  // namespace viewloom::photos
