// SPDX-License-Identifier: Apache-2.0
#include "web/atlas_message.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace viewloom::atlas_message_test {
namespace {

EncodedBand bandOf(AtlasPlane plane, std::vector<uint8_t> bytes) {
  EncodedBand band;
  band.plane = plane;
  band.bytes = std::make_shared<std::vector<uint8_t>>(std::move(bytes));
  return band;
}

std::vector<uint8_t> joined(const AtlasMessage& message) {
  std::vector<uint8_t> bytes;
  for (const auto& part : message.parts()) bytes.insert(bytes.end(), part.begin(), part.end());
  return bytes;
}

std::shared_ptr<EncodedAtlas> someAtlas() {
  auto atlas = std::make_shared<EncodedAtlas>();
  atlas->sequence = 7;
  atlas->frame_number = UINT64_MAX;
  atlas->coverage = {.hit = 3, .hidden = 1};
  auto layout = std::make_shared<AtlasLayout>();
  layout->views.resize(48);
  layout->suffix = "_qs8x6a0.75";
  atlas->layout = layout;
  atlas->bands = {bandOf(AtlasPlane::kColor, {1, 2}), bandOf(AtlasPlane::kColor, {3}),
                  bandOf(AtlasPlane::kDepth, {9, 9})};
  return atlas;
}

TEST(AtlasMessage, isALengthAHeaderAndTheBandsOfColourAndDepthJoined) {
  const AtlasMessage message(someAtlas(), {.delivery = 5, .dropped_count = 2});
  const std::vector<uint8_t> bytes = joined(message);
  ASSERT_EQ(bytes.size(), message.sizeBytes());
  const size_t length = bytes[0] | bytes[1] << 8 | bytes[2] << 16 | bytes[3] << 24;
  ASSERT_LE(4 + length, bytes.size());
  const auto begin = bytes.begin() + 4;
  const auto end = begin + static_cast<ptrdiff_t>(length);
  const auto header = nlohmann::json::parse(begin, end);
  EXPECT_EQ(header.at("sequence"), 7);
  EXPECT_EQ(header.at("delivery"), 5);
  EXPECT_EQ(header.at("dropped_count"), 2);
  EXPECT_EQ(header.at("frame_number"), "18446744073709551615");
  EXPECT_EQ(header.at("layout").at("view_count"), 48);
  EXPECT_EQ(header.at("coverage").at("hit"), 0.75);
  EXPECT_EQ(header.at("jpeg_bytes"), 3);
  EXPECT_EQ(header.at("depth_bytes"), 2);
  EXPECT_EQ(std::vector<uint8_t>(end, bytes.end()), (std::vector<uint8_t>{1, 2, 3, 9, 9}));
}

nlohmann::json headerOf(const std::shared_ptr<EncodedAtlas>& atlas) {
  const std::vector<uint8_t> bytes = joined(AtlasMessage(atlas, {}));
  const std::string text(bytes.begin() + 4, bytes.end());
  return nlohmann::json::parse(text.substr(0, text.rfind('}') + 1));
}

TEST(AtlasMessage, holdsTheViewsThatLookPastTheSource) {
  const auto atlas = someAtlas();
  EXPECT_EQ(headerOf(atlas).at("views_outside"), nlohmann::json::array());
  atlas->outside_shares = {0.25, 0.125, -0.5};
  EXPECT_EQ(headerOf(atlas).at("views_outside"),
            nlohmann::json::parse(R"([{"first_view": 0, "last_view": 1, "share": 0.25}])"));
}

TEST(AtlasMessage, saysWhichEyesSeeAPictureAndFromWhere) {
  const auto atlas = someAtlas();
  EXPECT_FALSE(headerOf(atlas).contains("eyes"));
  EXPECT_FALSE(headerOf(atlas).at("layout").contains("views")) << "48 are too many to list";
  atlas->eye_poses_time_ns = INT64_MAX;
  atlas->predicted_display_time_ns = 5;
  atlas->eye_poses_latched_ns = 7;
  atlas->eye_poses_age_ns = 3;
  auto layout = std::make_shared<AtlasLayout>();
  layout->views.push_back({{.pose = {.position_m = {1, 2, 3}},
                            .intrinsics = {.focal_px = {4, 5}, .principal_px = {6, 7}}}});
  atlas->layout = layout;
  const nlohmann::json header = headerOf(atlas);
  EXPECT_EQ(header.at("eyes"), nlohmann::json::parse(R"({"time_ns": "9223372036854775807",
      "predicted_display_time_ns": "5", "latched_ns": "7", "age_ns": 3})"));
  EXPECT_EQ(header.at("layout").at("views"), nlohmann::json::parse(R"([{
      "pose": {"position": {"x": 1.0, "y": 2.0, "z": 3.0},
               "orientation": {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}},
      "intrinsics": {"focal_x_px": 4.0, "focal_y_px": 5.0,
                     "principal_x_px": 6.0, "principal_y_px": 7.0}}])"));
}

TEST(AtlasMessage, listsTheBandsOfCompactDepth) {
  const auto atlas = someAtlas();
  EXPECT_FALSE(headerOf(atlas).contains("depth_bands"));
  atlas->encoding = {.with_depth = true, .planes = BandEncoding::kCompactDepth};
  atlas->bands[2].row_count = 128;
  atlas->bands.push_back(bandOf(AtlasPlane::kDepth, {8, 8, 8}));
  atlas->bands[3].first_row = 128;
  atlas->bands[3].row_count = 2;
  EXPECT_EQ(headerOf(atlas).at("depth_bytes"), 5);
  EXPECT_EQ(headerOf(atlas).at("depth_bands"), nlohmann::json::parse(R"([
      {"first_row": 0, "row_count": 128, "bytes": 2},
      {"first_row": 128, "row_count": 2, "bytes": 3}])"));
}

TEST(AtlasMessage, countsTheRowsOfCompactDepthThroughAllPictures) {
  const auto atlas = someAtlas();
  atlas->encoding = {
      .color = BandEncoding::kH264, .with_depth = true, .planes = BandEncoding::kCompactDepth};
  auto layout = std::make_shared<AtlasLayout>(*atlas->layout);
  layout->tile_size_px = {16, 20};
  ASSERT_TRUE(stackViews(*layout).ok());
  atlas->layout = layout;
  atlas->bands[2].image_index = 1;
  const nlohmann::json bands = headerOf(atlas).at("depth_bands");
  EXPECT_EQ(bands.at(0).at("first_row"), layout->stack->pictureSize().height);
}

// Readers of depth know nothing of the order of the video.
TEST(AtlasMessage, holdsDepthFromTheFirstPictureOnThoughThoseOfTheVideoComeBackward) {
  const auto atlas = someAtlas();
  atlas->encoding = {.color = BandEncoding::kH264, .with_depth = true};
  atlas->picture_order = PictureOrder::kBackward;
  atlas->bands[0].image_index = 1;
  atlas->bands[2].image_index = 1;
  atlas->bands.push_back(bandOf(AtlasPlane::kDepth, {8}));
  EXPECT_EQ(headerOf(atlas).at("is_backward"), true);
  EXPECT_EQ(headerOf(atlas).at("picture_bytes"), nlohmann::json::parse("[2, 1]"));
  const std::vector<uint8_t> bytes = joined(AtlasMessage(atlas, {}));
  EXPECT_EQ(std::vector<uint8_t>(bytes.end() - 6, bytes.end()),
            (std::vector<uint8_t>{1, 2, 3, 8, 9, 9}));
}

TEST(AtlasMessage, holdsTheTimesOfItsStages) {
  const auto atlas = someAtlas();
  atlas->times = {.build_ns = 4, .retime_ns = 5, .total_ns = 20};
  const nlohmann::json times = headerOf(atlas).at("times");
  EXPECT_EQ(times.at("build_ns"), 4);
  EXPECT_EQ(times.at("retime_ns"), 5);
  EXPECT_EQ(times.at("total_ns"), 20);
}

TEST(AtlasMessage, holdsTheDepthBudgetWhereThereIsOne) {
  const auto atlas = someAtlas();
  EXPECT_FALSE(headerOf(atlas).contains("depth_budget"));
  atlas->depth_budget = DepthBudget{.disparity_max_px = 9,
                                    .beyond_fusing_share = 0.5,
                                    .beyond_ghosting_share = 0.25,
                                    .suggested_focal_distance_m = 2,
                                    .suggested_view_cone_rad = 0.375};
  EXPECT_EQ(headerOf(atlas).at("depth_budget"),
            nlohmann::json::parse(R"({"disparity_max_px": 9.0, "beyond_fusing_share": 0.5,
                                      "beyond_ghosting_share": 0.25,
                                      "suggested_focal_distance_m": 2.0,
                                      "suggested_view_cone_rad": 0.375})"));
}

TEST(AtlasMessage, holdsPicturesOfAVideo) {
  const auto atlas = someAtlas();
  EXPECT_FALSE(headerOf(atlas).contains("picture_bytes"));
  atlas->encoding = {.color = BandEncoding::kH264, .video_qp = 30};
  atlas->video_qp = 34;
  atlas->bands[1].image_index = 1;
  auto layout = std::make_shared<AtlasLayout>(*atlas->layout);
  layout->tile_size_px = {16, 20};
  ASSERT_TRUE(stackViews(*layout).ok());
  atlas->layout = layout;
  const nlohmann::json header = headerOf(atlas);
  EXPECT_EQ(header.at("jpeg_bytes"), 0);
  EXPECT_EQ(header.at("picture_bytes"), nlohmann::json::parse("[2, 1]"));
  EXPECT_EQ(header.at("encoding").at("color"), "H264");
  EXPECT_EQ(header.at("encoding").at("video_qp"), 30);
  EXPECT_EQ(header.at("encoding").at("video_rung"), 0) << "its quality does not adapt";
  EXPECT_EQ(header.at("video_qp"), 34);
  const nlohmann::json& video = header.at("layout").at("video");
  EXPECT_EQ(video.at("picture_count"), 12);
  EXPECT_EQ(video.at("cell_size").at("height"), 20);
  EXPECT_EQ(video.at("codec_string"), "avc1.4D4C0A");
  EXPECT_EQ(header.at("layout").at("tile_size").at("height"), 20);
}

TEST(AtlasMessage, doesNotCopyTheBands) {
  const auto atlas = someAtlas();
  const AtlasMessage message(atlas, {});
  EXPECT_EQ(message.parts().at(2).data(), atlas->bands[0].bytes->data());
  EXPECT_EQ(message.parts().at(3).data(), atlas->bands[1].bytes->data());
}

TEST(AtlasMessage, holdsSharesOfNoRaysAsZero) {
  const auto atlas = someAtlas();
  atlas->coverage = {};
  const std::vector<uint8_t> bytes = joined(AtlasMessage(atlas, {}));
  EXPECT_EQ(std::string(bytes.begin(), bytes.end()).find("null"), std::string::npos);
}

}  // namespace
}  // namespace viewloom::atlas_message_test
