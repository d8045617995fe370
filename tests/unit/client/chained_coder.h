// SPDX-License-Identifier: Apache-2.0
// Atlases of chained video, without a server.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "lib/atlas.h"
#include "support/video/sample_picture.h"
#include "video/openh264_encoder.h"

namespace viewloom::test {

inline constexpr SizePx kView_px = {32, 16};
inline constexpr uint32_t kViews = 2;  // a picture each

inline v1::AtlasLayout stackedLayout(v1::Prediction prediction) {
  v1::AtlasLayout layout;
  layout.mutable_size()->set_width(kViews * kView_px.width);
  layout.mutable_size()->set_height(kView_px.height);
  layout.set_columns(kViews);
  layout.set_rows(1);
  layout.mutable_tile_size()->set_width(kView_px.width);
  layout.mutable_tile_size()->set_height(kView_px.height);
  layout.set_order(v1::TILE_ORDER_TOP_LEFT);
  layout.set_view_count(kViews);
  layout.set_image_count(1);
  layout.mutable_encoding()->set_color(v1::BAND_ENCODING_H264);
  layout.mutable_encoding()->set_prediction(prediction);
  v1::VideoStack& stack = *layout.mutable_video();
  stack.set_picture_count(kViews);
  stack.set_columns(1);
  stack.set_rows(1);
  *stack.mutable_picture_size() = layout.tile_size();
  *stack.mutable_cell_size() = layout.tile_size();
  return layout;
}

// Codes chained atlases as a server does: in turned order, one stream.
class ChainedCoder {
 public:
  // An atlas whose views have the greys `grey` and `grey` + 20.
  Atlas code(uint64_t sequence, uint64_t reference, uint8_t grey) {
    Atlas atlas{.layout = layout_, .header = {}, .end = {}, .bands = {}};
    atlas.header.set_sequence(sequence);
    atlas.header.set_reference_sequence(reference);
    const bool is_backward = sequence % 2 == 0;
    atlas.header.set_is_backward(is_backward);
    for (uint32_t place = 0; place < kViews; ++place) {
      const uint32_t view = is_backward ? kViews - 1 - place : place;
      const auto picture = SamplePicture::flat(kView_px, uint8_t(grey + 20 * view), 128, 128);
      std::vector<uint8_t> unit;
      const bool refers = reference != 0 || place > 0;
      const absl::Status status = encoder_->encode(
          picture.video(), refers ? Reference::kPictureBefore : Reference::kNone, unit);
      EXPECT_TRUE(status.ok()) << status;
      atlas.bands.push_back({.image_index = view,
                             .plane = v1::ATLAS_PLANE_COLOR,
                             .first_row = 0,
                             .row_count = kView_px.height,
                             .encoding = v1::BAND_ENCODING_H264,
                             .bytes = std::string(unit.begin(), unit.end())});
    }
    return atlas;
  }

 private:
  static std::unique_ptr<OpenH264Encoder> newEncoder() {
    auto encoder = OpenH264Encoder::make({.size_px = kView_px, .qp = 20});
    EXPECT_TRUE(encoder.ok()) << encoder.status();
    return *std::move(encoder);
  }

  const std::shared_ptr<const v1::AtlasLayout> layout_ =
      std::make_shared<const v1::AtlasLayout>(stackedLayout(v1::PREDICTION_ACROSS_ATLASES));
  const std::unique_ptr<OpenH264Encoder> encoder_ = newEncoder();
};

}  // namespace viewloom::test
