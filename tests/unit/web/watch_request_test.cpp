// SPDX-License-Identifier: Apache-2.0
#include "web/watch_request.h"

#include <gtest/gtest.h>

#include "access/access_control.h"
#include "web/asked_display.h"

namespace viewloom::watch_request_test {
namespace {

class WatchRequests : public testing::Test {
 protected:
  WatchRequests() : streams_(clock_, 4), claim_(*streams_.claim("scene", "", [] {})) {}

  absl::StatusOr<WatchRequest> parse(QueryParameters parameters) {
    parameters.emplace("stream", "scene");
    const absl::StatusOr<AskedDisplay> asked = askedDisplay(parameters);
    if (!asked.ok()) return asked.status();
    absl::StatusOr<WatchRequest> request = makeWatchRequest(*asked);
    if (!request.ok()) return inParameters(request.status(), parameters);
    const absl::Status status =
        checkStream(request->stream, *access_.admit("/ws", "", ""), streams_);
    if (!status.ok()) return status;
    return request;
  }
  std::string fieldAtFault(const QueryParameters& parameters) {
    return fieldOf(parse(parameters).status());
  }
  std::string messageOf(const QueryParameters& parameters) {
    return std::string(parse(parameters).status().message());
  }

  ManualClock clock_;
  AccessControl access_{clock_};
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

TEST_F(WatchRequests, takeAPresetAndASizeByHand) {
  const auto request = parse({{"preset", "portrait"}, {"width", "800"}, {"height", "600"}});
  ASSERT_TRUE(request.ok()) << request.status();
  EXPECT_EQ(std::get<QuiltSpec>(request->display.kind).columns, 8u);
  EXPECT_EQ(std::get<QuiltSpec>(request->display.kind).size_px, (SizePx{800, 600}));
  const auto depth = parse({{"preset", "wowvx"}, {"width", "64"}, {"height", "48"}});
  ASSERT_TRUE(depth.ok()) << depth.status();
  EXPECT_EQ(std::get<RgbdSpec>(depth->display.kind).view_size_px, (SizePx{64, 48}));
  const auto lenses = parse({{"preset", "near_eye_2013"}});
  ASSERT_TRUE(lenses.ok()) << lenses.status();
  EXPECT_EQ(std::get<IntegralSpec>(lenses->display.kind).panel_px, (SizePx{1280, 720}));
}

TEST_F(WatchRequests, takeTheFirstAcceptedColorThatServesTheDisplay) {
  const auto colorOf = [this](const char* accepted, const char* preset) {
    const auto request = parse({{"accepted", accepted}, {"preset", preset}});
    EXPECT_TRUE(request.ok()) << request.status();
    return request.ok() ? request->encoding.color : BandEncoding::kRaw;
  };
  const char* const both = R"([{"color": "BAND_ENCODING_H264"}, {"color": "BAND_ENCODING_JPEG"}])";
  EXPECT_EQ(colorOf(both, "portrait"), BandEncoding::kH264);
  EXPECT_EQ(colorOf(both, "near_eye_2013"), BandEncoding::kJpeg);
  const char* const usual = R"([{"color": "BAND_ENCODING_H264"}, {}])";
  EXPECT_EQ(colorOf(usual, "portrait"), BandEncoding::kH264);
  EXPECT_EQ(colorOf(usual, "near_eye_2013"), BandEncoding::kJpeg);
  EXPECT_EQ(colorOf(R"([{"color": "BAND_ENCODING_JPEG"}])", "portrait"), BandEncoding::kJpeg);
  EXPECT_EQ(colorOf(R"([{"color": "BAND_ENCODING_ZSTD"},
                        {"color": "BAND_ENCODING_H264", "level_max": 10},
                        {"color": "BAND_ENCODING_JPEG"}])",
                    "portrait"),
            BandEncoding::kJpeg);
  EXPECT_EQ(parse({{"accepted", both}, {"encoding", R"({"color": "BAND_ENCODING_JPEG"})"}})
                ->encoding.color,
            BandEncoding::kJpeg);
  EXPECT_EQ(fieldAtFault({{"accepted", R"([{"color": "BAND_ENCODING_ZSTD"}])"}}), "accepted");
  EXPECT_EQ(fieldAtFault({{"accepted", R"([{"color": 3}, {"colour": 1}])"}}).substr(0, 8),
            "accepted");
  EXPECT_EQ(fieldAtFault({{"accepted", "nothing"}}), "accepted");
}

TEST_F(WatchRequests, takeAnyDisplayAndEncodingAsJson) {
  const auto request =
      parse({{"display",
              R"({"quilt": {"preset": "portrait", "size": {"width": 800, "height": 600},
            "view_cone_rad": 0.5, "focalDistanceM": 1.25, "cone_begin": 0.25, "cone_end": 0.5},
            "effects": {"reflection": {"bounces": 3}, "lens": {"aperture_radius_m": 0.02}},
            "quality": "QUALITY_BEST"})"},
             {"encoding", R"({"jpeg_quality": 60, "chroma": "CHROMA_SUBSAMPLING_444"})"}});
  ASSERT_TRUE(request.ok()) << request.status();
  const auto& quilt = std::get<QuiltSpec>(request->display.kind);
  EXPECT_EQ(quilt.columns, 8u);
  EXPECT_EQ(quilt.size_px, (SizePx{800, 600}));
  EXPECT_EQ(quilt.view_cone_rad, 0.5);
  EXPECT_EQ(quilt.focal_distance_m, 1.25);
  EXPECT_EQ(quilt.cone_begin, 0.25);
  EXPECT_EQ(quilt.cone_end, 0.5);
  EXPECT_EQ(request->display.reflection.value().bounce_count, 3u);
  EXPECT_EQ(request->display.lens.value().walked_count, 16u);
  EXPECT_EQ(request->display.tolerance_px, 0.0625);
  EXPECT_EQ(request->encoding.jpeg_quality, 60u);
  EXPECT_EQ(request->encoding.chroma, Chroma::k444);
}

TEST_F(WatchRequests, serveKindsThatHaveNoPageAsOneJpeg) {
  const auto panel = parse({{"display", R"({"lenticular": {"preset": "portrait"}})"}});
  ASSERT_TRUE(panel.ok()) << panel.status();
  EXPECT_EQ(panel->encoding.color, BandEncoding::kJpeg);
  EXPECT_EQ(panel->encoding.chroma, Chroma::k444);
  const auto pair =
      parse({{"display", R"({"stereo": {"eye_size": {"width": 64, "height": 48}}})"}});
  ASSERT_TRUE(pair.ok()) << pair.status();
  EXPECT_EQ(*quiltSuffix(pair->display), "");
}

TEST_F(WatchRequests, refuseWhatTheWebCannotCarry) {
  const std::string eye = R"("eye_size": {"width": 64, "height": 48})";
  const auto tracked = parse({{"display", R"({"stereo": {"tracked": true, )" + eye + "}}"}});
  ASSERT_TRUE(tracked.ok()) << tracked.status();
  EXPECT_EQ(fieldOf(checkUntracked(tracked->display)), "display.stereo.tracked")
      << "a still has no eyes";
  EXPECT_EQ(fieldAtFault(
                {{"display", R"({"stereo": {"layout": "STEREO_LAYOUT_SEPARATE", )" + eye + "}}"}}),
            "display.stereo.eye_size");
  EXPECT_EQ(fieldAtFault({{"display", R"({"rgbd": {"preset": "wowvx", "depth_bits": 16}})"}}),
            "display.rgbd.depth_bits");
  EXPECT_EQ(fieldAtFault({{"encoding", R"({"color": "BAND_ENCODING_ZSTD"})"}}), "encoding.color");
  EXPECT_EQ(parse({{"encoding", R"({"color": "BAND_ENCODING_H264"})"}})->encoding.color,
            BandEncoding::kH264);
  EXPECT_EQ(fieldAtFault({{"encoding", R"({"with_mask": true})"}}), "encoding.with_mask");
  EXPECT_EQ(fieldAtFault({{"encoding", R"({"with_depth": true, "planes": "BAND_ENCODING_ZSTD"})"}}),
            "encoding.planes");
  EXPECT_EQ(parse({{"encoding", R"({"with_depth": true})"}})->encoding.planes, BandEncoding::kRaw);
  const auto compact =
      parse({{"encoding", R"({"with_depth": true, "planes": "BAND_ENCODING_COMPACT_DEPTH"})"}});
  EXPECT_EQ(compact->encoding.planes, BandEncoding::kCompactDepth);
}

TEST_F(WatchRequests, nameTheFieldAtFaultAsTheApiDoes) {
  EXPECT_EQ(messageOf({{"display", R"({"quilt": {"preset": "portrait", "columns": 51}})"}}),
            "display.quilt.columns: got 51; accepted is 1..50");
  EXPECT_EQ(fieldAtFault({{"display", R"({"quilt": {"preset": "portrait", "aspect": "NaN"}})"}}),
            "display.quilt.aspect");
  EXPECT_EQ(fieldAtFault({{"display", "{}"}}), "display.kind");
  EXPECT_EQ(fieldAtFault({{"encoding", R"({"jpeg_quality": 101})"}}), "encoding.jpeg_quality");
  EXPECT_EQ(fieldAtFault({{"display", R"({"focus_following_s": 1, "rgbd": {"preset": "wowvx"}})"}}),
            "display.focus_following_s");
}

TEST_F(WatchRequests, nameTheParameterOfWhatCameByHand) {
  EXPECT_EQ(fieldAtFault({{"preset", "portait"}}), "preset");
  EXPECT_NE(messageOf({{"preset", "near_eye"}}).find("did you mean \"near_eye_2013\""),
            std::string::npos);
  EXPECT_EQ(fieldAtFault({{"width", "x"}}), "width");
  EXPECT_EQ(messageOf({{"width", "3"}, {"height", "3000"}}),
            "width: the quilt is 3 px wide and has 8 columns; accepted is at least 1 px a column");
  EXPECT_EQ(fieldAtFault({{"width", "800"}, {"display", R"({"preset": "portrait"})"}}), "width");
  const std::string unknown = messageOf({{"columns", "4"}});
  EXPECT_TRUE(
      unknown.starts_with("columns: there is no such parameter; known parameters: stream, "
                          "display, encoding, accepted, preset, width, height"))
      << unknown;
}

TEST_F(WatchRequests, sayWhichStreamsExist) {
  const absl::Status status = parse({{"stream", "sceen"}}).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kNotFound);
  EXPECT_EQ(status.message(),
            "stream: there is no stream \"sceen\"; known streams: scene; did you mean \"scene\"?");
}

}  // namespace
}  // namespace viewloom::watch_request_test
