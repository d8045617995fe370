// SPDX-License-Identifier: Apache-2.0
#include "lib/stacked_atlas.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "lib/atlas_assembler.h"
#include "support/video/sample_picture.h"
#include "video/openh264_encoder.h"

namespace viewloom::stacked_atlas_test {
namespace {

constexpr uint32_t kViews = 5;
constexpr uint32_t kPictures = 3;
constexpr SizePx kCell_px = {24, 20};
constexpr SizePx kPicture_px = {48, 20};

void setSize(v1::SizePx& proto, uint32_t width, uint32_t height) {
  proto.set_width(width);
  proto.set_height(height);
}

// 2 columns and 3 rows of 23x19 px from the bottom left, and padding; in pictures of 2 cells.
v1::AtlasLayout layoutOfQuilt() {
  v1::AtlasLayout layout;
  setSize(*layout.mutable_size(), 47, 59);
  layout.set_columns(2);
  layout.set_rows(3);
  setSize(*layout.mutable_tile_size(), 23, 19);
  layout.set_order(v1::TILE_ORDER_BOTTOM_LEFT);
  layout.set_view_count(kViews);
  layout.set_padding_right_px(1);
  layout.set_padding_top_px(2);
  layout.set_image_count(1);
  v1::VideoStack& stack = *layout.mutable_video();
  stack.set_picture_count(kPictures);
  setSize(*stack.mutable_picture_size(), kPicture_px.width, kPicture_px.height);
  stack.set_columns(2);
  stack.set_rows(1);
  setSize(*stack.mutable_cell_size(), kCell_px.width, kCell_px.height);
  return layout;
}

// Grey of a view, far from that of others.
uint8_t greyOf(uint32_t view) {
  return uint8_t(40 + 40 * view);
}

AtlasBand bandOf(uint32_t picture, v1::AtlasPlane plane, v1::BandEncoding encoding,
                 std::string bytes) {
  return {.image_index = picture,
          .plane = plane,
          .first_row = 0,
          .row_count = kPicture_px.height,
          .encoding = encoding,
          .bytes = std::move(bytes)};
}

// Each cell has the grey of its view.
test::SamplePicture pictureOf(uint32_t picture) {
  test::SamplePicture sample(kPicture_px);
  for (uint32_t y = 0; y < kPicture_px.height; ++y) {
    for (uint32_t x = 0; x < kPicture_px.width; ++x) {
      const uint32_t view = picture + kPictures * (x / kCell_px.width);
      sample.luma(x, y) = view < kViews ? greyOf(view) : uint8_t{0};
    }
  }
  return sample;
}

Atlas codedAtlas() {
  Atlas atlas{.layout = std::make_shared<const v1::AtlasLayout>(layoutOfQuilt()),
              .header = {},
              .end = {},
              .bands = {}};
  auto encoder = OpenH264Encoder::make({.size_px = kPicture_px, .qp = 20});
  EXPECT_TRUE(encoder.ok()) << encoder.status();
  for (uint32_t picture = 0; picture < kPictures; ++picture) {
    const test::SamplePicture sample = pictureOf(picture);
    const uint8_t* const luma = sample.video().y;
    std::vector<uint8_t> unit;
    const absl::Status status = (*encoder)->encode(
        sample.video(), picture == 0 ? Reference::kNone : Reference::kPictureBefore, unit);
    EXPECT_TRUE(status.ok()) << status;
    atlas.bands.push_back(bandOf(picture, v1::ATLAS_PLANE_COLOR, v1::BAND_ENCODING_H264,
                                 std::string(unit.begin(), unit.end())));
    atlas.bands.push_back(bandOf(picture, v1::ATLAS_PLANE_MASK, v1::BAND_ENCODING_RAW,
                                 std::string(luma, luma + kPicture_px.area())));
  }
  return atlas;
}

TEST(StackedAtlas, putsTheViewsWhereTheLayoutSays) {
  const Atlas atlas = codedAtlas();
  for (const v1::AtlasPlane plane : {v1::ATLAS_PLANE_COLOR, v1::ATLAS_PLANE_MASK}) {
    const auto picture = decodePlane(atlas, plane);
    ASSERT_TRUE(picture.ok()) << picture.status();
    EXPECT_EQ(picture->width_px, 47u);
    EXPECT_EQ(picture->height_px, 59u);
    for (uint32_t view = 0; view < kViews; ++view) {
      const AtlasPicture cut = cutView(*picture, *atlas.layout, view);
      for (const uint8_t sample : cut.samples) ASSERT_NEAR(sample, greyOf(view), 3) << view;
      const size_t middle = cut.samples.size() / 2;
      EXPECT_NEAR(cut.samples[middle], greyOf(view), 1) << "flat patches stay flat";
    }
    EXPECT_EQ(picture->samples.front(), 0) << "above the tiles";
    EXPECT_EQ(picture->samples[size_t{picture->width_px} * picture->channels * 3 - 1], 0)
        << "right of the tiles";
  }
}

TEST(StackedAtlas, refusesDamagedPicturesAsAWhole) {
  for (size_t at = 0; at < 3 * kPictures; ++at) {
    Atlas atlas = codedAtlas();
    std::string& bytes = atlas.bands[at / 3 * 2].bytes;
    if (at % 3 == 0) bytes.clear();
    if (at % 3 == 1) bytes.resize(bytes.size() / 2);
    if (at % 3 == 2) bytes = "no picture";
    const absl::Status refused = decodePlane(atlas, v1::ATLAS_PLANE_COLOR).status();
    EXPECT_EQ(refused.code(), absl::StatusCode::kDataLoss) << at;
    EXPECT_THAT(std::string(refused.message()),
                testing::HasSubstr("picture " + std::to_string(at / 3)));
  }
}

TEST(StackedAtlas, needsAllPictures) {
  Atlas atlas = codedAtlas();
  atlas.bands[2].image_index = 7;
  EXPECT_EQ(decodePlane(atlas, v1::ATLAS_PLANE_COLOR).status().code(),
            absl::StatusCode::kFailedPrecondition);
  atlas = codedAtlas();
  atlas.bands.push_back(bandOf(7, v1::ATLAS_PLANE_COLOR, v1::BAND_ENCODING_H264, "of no picture"));
  EXPECT_TRUE(decodePlane(atlas, v1::ATLAS_PLANE_COLOR).ok()) << "others do not matter";
}

TEST(StackedAtlas, refusesVideoWithoutAStack) {
  Atlas atlas = codedAtlas();
  v1::AtlasLayout layout = *atlas.layout;
  layout.clear_video();
  layout.set_image_count(kPictures);
  atlas.layout = std::make_shared<const v1::AtlasLayout>(layout);
  for (AtlasBand& band : atlas.bands) band.row_count = 59 / kPictures;
  EXPECT_EQ(decodePlane(atlas, v1::ATLAS_PLANE_COLOR).status().code(), absl::StatusCode::kDataLoss);
}

TEST(StackedAtlas, refusesStacksThatDoNotHoldTheViews) {
  EXPECT_TRUE(checkStack(layoutOfQuilt()).ok());
  const auto spoilt = [](const auto& spoil) {
    v1::AtlasLayout layout = layoutOfQuilt();
    spoil(*layout.mutable_video());
    v1::StreamAtlasesResponse message;
    *message.mutable_layout() = layout;
    return AtlasAssembler().add(std::move(message)).status().code();
  };
  using Stack = v1::VideoStack;
  const auto kLoss = absl::StatusCode::kDataLoss;
  EXPECT_EQ(spoilt([](Stack&) {}), absl::StatusCode::kOk);
  EXPECT_EQ(spoilt([](Stack& stack) { stack.set_picture_count(0); }), kLoss);
  EXPECT_EQ(spoilt([](Stack& stack) { stack.set_picture_count(2); }), kLoss);
  EXPECT_EQ(spoilt([](Stack& stack) { stack.set_picture_count(1u << 31); }), kLoss);
  EXPECT_EQ(spoilt([](Stack& stack) { stack.set_columns(0); }), kLoss);
  EXPECT_EQ(spoilt([](Stack& stack) { stack.set_columns(1u << 31); }), kLoss);
  EXPECT_EQ(spoilt([](Stack& stack) { stack.set_rows(2); }), kLoss);
  EXPECT_EQ(spoilt([](Stack& stack) { stack.mutable_cell_size()->set_width(22); }), kLoss);
  EXPECT_EQ(spoilt([](Stack& stack) { stack.mutable_cell_size()->set_height(0); }), kLoss);
  EXPECT_EQ(spoilt([](Stack& stack) { stack.mutable_picture_size()->set_width(46); }), kLoss);
  EXPECT_EQ(spoilt([](Stack& stack) { stack.clear_picture_size(); }), kLoss);
}

}  // namespace
}  // namespace viewloom::stacked_atlas_test
