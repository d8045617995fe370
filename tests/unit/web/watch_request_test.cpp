// SPDX-License-Identifier: Apache-2.0
#include "web/watch_request.h"

#include <gtest/gtest.h>

#include <numbers>

namespace viewloom {
namespace {

class WatchRequests : public testing::Test {
 protected:
  WatchRequests() : streams_(clock_, 4), claim_(*streams_.claim("scene", "", [] {})) {}

  absl::StatusOr<WatchRequest> parse(QueryParameters parameters) {
    parameters.emplace("stream", "scene");
    return parseWatchRequest(parameters, streams_);
  }

  ManualClock clock_;
  StreamDirectory streams_;
  std::unique_ptr<StreamDirectory::Claim> claim_;
};

TEST_F(WatchRequests, arePortraitWhenNothingIsSaid) {
  const auto request = parse({});
  ASSERT_TRUE(request.ok()) << request.status();
  const auto& quilt = std::get<QuiltSpec>(request->display.kind);
  EXPECT_EQ(quilt.columns, 8u);
  EXPECT_EQ(quilt.rows, 6u);
  EXPECT_EQ(quilt.size_px, (SizePx{3360, 3360}));
  EXPECT_EQ(request->encoding, EncodingSpec{});
  EXPECT_EQ(*quiltSuffix(request->display), "_qs8x6a0.75");
}

TEST_F(WatchRequests, overrideThePreset) {
  const auto request = parse({{"preset", "portrait"},
                              {"width", "800"},
                              {"height", "600"},
                              {"cone_deg", "30"},
                              {"fov_deg", "20"},
                              {"focus_m", "1.25"},
                              {"focus_follow_s", "0.5"},
                              {"reflections", "3"},
                              {"quality", "60"},
                              {"chroma", "444"}});
  ASSERT_TRUE(request.ok()) << request.status();
  const auto& quilt = std::get<QuiltSpec>(request->display.kind);
  EXPECT_EQ(quilt.columns, 8u);
  EXPECT_EQ(quilt.size_px, (SizePx{800, 600}));
  EXPECT_DOUBLE_EQ(quilt.view_cone_rad, std::numbers::pi / 6);
  EXPECT_DOUBLE_EQ(quilt.fov_y_rad, std::numbers::pi / 9);
  EXPECT_EQ(quilt.focal_distance_m, 1.25);
  EXPECT_EQ(request->display.focus_following_s, 0.5);
  EXPECT_EQ(request->display.reflection.value().bounce_count, 3u);
  EXPECT_EQ(request->encoding.jpeg_quality, 60u);
  EXPECT_EQ(request->encoding.chroma, Chroma::k444);
}

TEST_F(WatchRequests, nameTheParameterAtFaultAndWhatIsAccepted) {
  const auto bad = parse({{"cone_deg", "400"}});
  EXPECT_EQ(fieldOf(bad.status()), "cone_deg");
  EXPECT_NE(bad.status().message().find("radians"), absl::string_view::npos);
  EXPECT_EQ(fieldOf(parse({{"focus_follow_s", "61"}}).status()), "focus_follow_s");
  EXPECT_EQ(fieldOf(parse({{"reflections", "0"}}).status()), "reflections");
  const auto unknown = parse({{"color", "red"}});
  EXPECT_EQ(fieldOf(unknown.status()), "color");
  EXPECT_NE(unknown.status().message().find("cone_deg"), absl::string_view::npos);
}

TEST_F(WatchRequests, sayWhichStreamsExist) {
  const auto request = parseWatchRequest({{"stream", "sceen"}}, streams_);
  EXPECT_EQ(request.status().code(), absl::StatusCode::kNotFound);
  EXPECT_EQ(request.status().message(), "stream: there is no \"sceen\"; there are scene");
}

}  // namespace
}  // namespace viewloom
