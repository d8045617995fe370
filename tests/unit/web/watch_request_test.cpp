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

TEST_F(WatchRequests, seeThroughALensOfAnEffort) {
  const auto lens = parse({{"aperture_m", "0.02"}, {"lens_focus_m", "3"}, {"effort", "best"}});
  ASSERT_TRUE(lens.ok()) << lens.status();
  EXPECT_EQ(lens->display.lens->aperture_radius_m, 0.02);
  EXPECT_EQ(lens->display.lens->focus_distance_m, 3);
  EXPECT_EQ(lens->display.lens->walked_count, 16u);
  EXPECT_EQ(lens->display.tolerance_px, 0.0625);
  const auto automatic = parse({{"aperture_m", "auto"}});
  ASSERT_TRUE(automatic.ok()) << automatic.status();
  EXPECT_TRUE(automatic->display.lens->has_automatic_aperture);
  EXPECT_FALSE(parse({})->display.lens.has_value());
  EXPECT_EQ(fieldOf(parse({{"aperture_m", "-1"}}).status()), "aperture_m");
  EXPECT_EQ(fieldOf(parse({{"aperture_m", "1"}, {"lens_focus_m", "0"}}).status()), "lens_focus_m");
  EXPECT_EQ(fieldOf(parse({{"effort", "all"}}).status()), "effort");
}

TEST_F(WatchRequests, areColorWithDepthByItsPresetOrByName) {
  const auto preset =
      parse({{"preset", "wowvx_declipse"}, {"width", "64"}, {"height", "48"}, {"screen_m", "2"}});
  ASSERT_TRUE(preset.ok()) << preset.status();
  const auto& declipse = std::get<RgbdSpec>(preset->display.kind);
  EXPECT_EQ(declipse.form, RgbdForm::kTwoLayers);
  EXPECT_EQ(declipse.view_size_px, (SizePx{64, 48}));
  EXPECT_EQ(declipse.screen_m, 2);
  EXPECT_EQ(preset->encoding.chroma, Chroma::k444);

  const auto named = parse({{"rgbd", "color-depth"},
                            {"width", "64"},
                            {"height", "48"},
                            {"depth_side", "bottom"},
                            {"black_near", "1"},
                            {"near_m", "1"},
                            {"far_m", "9"},
                            {"chroma", "420"}});
  ASSERT_TRUE(named.ok()) << named.status();
  const auto& rgbd = std::get<RgbdSpec>(named->display.kind);
  EXPECT_EQ(rgbd.form, RgbdForm::kColorDepth);
  EXPECT_EQ(rgbd.depth_placement, DepthPlacement::kBottom);
  EXPECT_TRUE(rgbd.is_black_near);
  EXPECT_EQ(rgbd.near_m, 1);
  EXPECT_EQ(rgbd.far_m, 9);
  EXPECT_EQ(named->encoding.chroma, Chroma::k420);
  EXPECT_EQ(*quiltSuffix(named->display), "");
}

TEST_F(WatchRequests, openEveryKindByTheNameOfADevice) {
  const auto depth = parse({{"preset", "wowvx"}});
  ASSERT_TRUE(depth.ok()) << depth.status();
  EXPECT_EQ(std::get<RgbdSpec>(depth->display.kind).view_size_px, (SizePx{960, 540}));
  const auto lenses = parse({{"preset", "near_eye_2013"}, {"reflections", "2"}});
  ASSERT_TRUE(lenses.ok()) << lenses.status();
  EXPECT_EQ(std::get<IntegralSpec>(lenses->display.kind).panel_px, (SizePx{1280, 720}));
  EXPECT_EQ(fieldOf(parse({{"preset", "near_eye_2013"}, {"columns", "4"}}).status()), "columns");
  const auto unknown = parse({{"preset", "near_eye"}}).status();
  EXPECT_EQ(fieldOf(unknown), "preset");
  EXPECT_NE(unknown.message().find("did you mean \"near_eye_2013\""), std::string::npos);
  const auto other =
      parse({{"rgbd", "two-layers"}, {"preset", "portrait"}, {"width", "9"}, {"height", "9"}});
  EXPECT_EQ(fieldOf(other.status()), "preset");
  EXPECT_NE(other.status().message().find("is a display of another kind"), std::string::npos);
}

TEST_F(WatchRequests, nameTheParameterOfColorWithDepthAtFault) {
  EXPECT_EQ(fieldOf(parse({{"rgbd", "both"}}).status()), "rgbd");
  const QueryParameters whole{{"rgbd", "two-layers"}, {"width", "64"}, {"height", "48"}};
  for (const auto& [name, value] : QueryParameters{{"depth_side", "left"},
                                                   {"black_near", "yes"},
                                                   {"cone_deg", "40"},
                                                   {"focus_follow_s", "1"},
                                                   {"preset", "portrait"},
                                                   {"screen_m", "-1"}}) {
    QueryParameters bad = whole;
    bad.emplace(name, value);
    EXPECT_EQ(fieldOf(parse(bad).status()), name);
  }
}

TEST_F(WatchRequests, askForAtlasesBetweenFramesByTheirRate) {
  const auto request = parse({{"rate_hz", "60"}, {"between", "interpolate"}});
  ASSERT_TRUE(request.ok()) << request.status();
  ASSERT_TRUE(request->display.temporal.has_value());
  EXPECT_EQ(request->display.temporal->output_rate_hz, 60);
  EXPECT_EQ(request->display.temporal->mode, TemporalMode::kInterpolate);
  EXPECT_FALSE(parse({{"between", "predict"}})->display.temporal.has_value());
  EXPECT_EQ(fieldOf(parse({{"rate_hz", "0"}}).status()), "rate_hz");
  EXPECT_EQ(fieldOf(parse({{"rate_hz", "241"}}).status()), "rate_hz");
  EXPECT_EQ(fieldOf(parse({{"rate_hz", "60"}, {"between", "frames"}}).status()), "between");
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
  EXPECT_EQ(request.status().message(),
            "stream: there is no \"sceen\"; there are scene; did you mean \"scene\"?");
}

}  // namespace
}  // namespace viewloom
