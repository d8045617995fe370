// SPDX-License-Identifier: Apache-2.0
#include "lib/color_decoder.h"

#include <utility>

#include "base/str_cat.h"
#include "lib/stacked_atlas.h"
#include "video/openh264_decoder.h"

namespace viewloom {
namespace {

// Each takes a few megabytes. Servers make some tens of pictures at most.
constexpr uint32_t kDecodersMax = 256;

bool isChained(const Atlas& atlas) {
  return atlas.layout->has_video() &&
         atlas.layout->encoding().prediction() == v1::PREDICTION_ACROSS_ATLASES &&
         isWholeVideo(atlas);
}

}  // namespace

ColorDecoder::ColorDecoder() = default;
ColorDecoder::~ColorDecoder() = default;
ColorDecoder::ColorDecoder(ColorDecoder&&) noexcept = default;
ColorDecoder& ColorDecoder::operator=(ColorDecoder&&) noexcept = default;

absl::StatusOr<AtlasPicture> ColorDecoder::decode(const Atlas& atlas) {
  if (!isChained(atlas)) {
    sequence_ = 0;
    return decodePlane(atlas, v1::ATLAS_PLANE_COLOR);
  }
  const absl::Status prepared = prepare(atlas);
  sequence_ = 0;  // until it is decoded
  VIEWLOOM_RETURN_IF_ERROR(prepared);
  absl::StatusOr<AtlasPicture> picture =
      decodeVideo(atlas, [this](uint32_t index) -> VideoDecoder& { return *decoders_[index]; });
  if (picture.ok()) sequence_ = atlas.header.sequence();
  return picture;
}

absl::Status ColorDecoder::prepare(const Atlas& atlas) {
  const uint64_t reference = atlas.header.reference_sequence();
  const uint32_t count = atlas.layout->video().picture_count();
  if (reference != 0) {
    // A stack of more pictures, or of fewer, has nothing that it could refer to.
    const bool is_known = reference == sequence_ && count == decoders_.size();
    return is_known ? absl::OkStatus() : refusedReference(atlas);
  }
  if (count > kDecodersMax) {
    return absl::ResourceExhaustedError(strCat("the layout has chained video of ", count,
                                               " pictures; accepted are up to ", kDecodersMax));
  }
  // Pictures of another size, too, come with new decoders.
  decoders_.clear();
  for (uint32_t i = 0; i < count; ++i) {
    auto decoder = OpenH264Decoder::make();
    VIEWLOOM_RETURN_IF_ERROR(decoder.status());
    decoders_.push_back(*std::move(decoder));
  }
  return absl::OkStatus();
}

}  // namespace viewloom
