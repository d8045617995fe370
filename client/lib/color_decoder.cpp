// SPDX-License-Identifier: Apache-2.0
#include "lib/color_decoder.h"

#include <utility>

#include "lib/stacked_atlas.h"
#include "video/openh264_decoder.h"

namespace viewloom {
namespace {

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
  absl::StatusOr<AtlasPicture> picture = decodeVideo(atlas, *decoder_);
  if (picture.ok()) sequence_ = atlas.header.sequence();
  return picture;
}

absl::Status ColorDecoder::prepare(const Atlas& atlas) {
  const uint64_t reference = atlas.header.reference_sequence();
  if (reference != 0) {
    const bool is_known = decoder_ != nullptr && reference == sequence_;
    return is_known ? absl::OkStatus() : refusedReference(atlas);
  }
  // Pictures of another size, too, come with a new decoder.
  auto decoder = OpenH264Decoder::make();
  VIEWLOOM_RETURN_IF_ERROR(decoder.status());
  decoder_ = *std::move(decoder);
  return absl::OkStatus();
}

}  // namespace viewloom
