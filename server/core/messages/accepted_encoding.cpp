// SPDX-License-Identifier: Apache-2.0
#include "messages/accepted_encoding.h"

#include <string>

#include "base/str_cat.h"
#include "display/atlas_layout.h"
#include "display/video_stack.h"
#include "messages/display_from_proto.h"
#include "video/h264_parameters.h"

namespace viewloom {
namespace {

// Each of them plans the stack of the display, and may add its reason to an error.
constexpr int kAcceptedMax = 32;

// A limit that the client gives, else the largest that there is.
uint32_t limitOf(uint32_t given, uint32_t largest) {
  return given == 0 ? largest : given;
}

absl::Status checkPictures(const v1::AcceptedEncoding& accepted, const DisplaySpec& display) {
  const TileGrid grid = tileGridOf(display);
  const absl::StatusOr<VideoStack> stack = planVideoStack(grid.tile_size_px, grid.view_count);
  VIEWLOOM_RETURN_IF_ERROR(stack.status());
  const SizePx picture_px = stack->pictureSize();
  const SizePx max_px = {limitOf(accepted.picture_size_max().width(), kVideoPictureMax_px.width),
                         limitOf(accepted.picture_size_max().height(), kVideoPictureMax_px.height)};
  const uint32_t level_max = limitOf(accepted.level_max(), kH264LevelMax);
  const uint32_t level = h264Level(picture_px);
  if (picture_px.width <= max_px.width && picture_px.height <= max_px.height &&
      level <= level_max) {
    return absl::OkStatus();
  }
  return absl::InvalidArgumentError(strCat(
      "pictures have ", picture_px.width, "x", picture_px.height, " px and level ", level,
      "; the client accepts ", max_px.width, "x", max_px.height, " px and level ", level_max));
}

absl::StatusOr<EncodingSpec> tryOne(const v1::AtlasEncoding& asked,
                                    const v1::AcceptedEncoding& accepted,
                                    const DisplaySpec& display) {
  v1::AtlasEncoding encoding = asked;
  encoding.set_color(accepted.color());
  absl::StatusOr<EncodingSpec> tried = encodingFromProto(encoding, display);
  VIEWLOOM_RETURN_IF_ERROR(tried.status());
  if (tried->color == BandEncoding::kH264) {
    VIEWLOOM_RETURN_IF_ERROR(checkPictures(accepted, display));
  }
  return tried;
}

}  // namespace

absl::StatusOr<EncodingSpec> chooseEncoding(const v1::AtlasEncoding& asked,
                                            const AcceptedEncodings& accepted,
                                            const DisplaySpec& display) {
  if (accepted.size() > kAcceptedMax) {
    return invalidField(
        "accepted", strCat("got ", accepted.size(), " encodings; accepted are up to ", kAcceptedMax,
                           ": list each color once"));
  }
  if (accepted.empty() || asked.color() != v1::BAND_ENCODING_UNSPECIFIED) {
    absl::StatusOr<EncodingSpec> encoding = encodingFromProto(asked, display);
    if (!encoding.ok()) return withFieldPrefix(encoding.status(), "encoding");
    return encoding;
  }
  std::string reasons;
  for (const v1::AcceptedEncoding& one : accepted) {
    absl::StatusOr<EncodingSpec> tried = tryOne(asked, one, display);
    if (tried.ok()) return tried;
    reasons += strCat(reasons.empty() ? "" : "; ", v1::BandEncoding_Name(one.color()), ": ",
                      tried.status().message());
  }
  return invalidField("accepted", strCat("none of these serves the display (", reasons,
                                         "); BAND_ENCODING_JPEG_PLANES and BAND_ENCODING_ZSTD "
                                         "serve every display"));
}

}  // namespace viewloom
