// SPDX-License-Identifier: Apache-2.0
// Displays that cannot be served: each with the status and the field it is refused with.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "e2e/bad_display.h"
#include "e2e/bystander.h"

namespace viewloom::rpc_bad_displays_test {
namespace {

using ::testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr auto kInvalid = grpc::StatusCode::INVALID_ARGUMENT;
constexpr auto kMissing = grpc::StatusCode::NOT_FOUND;

v1::QuiltDisplay& quilt(v1::OpenDisplay& open) {
  return *open.mutable_display()->mutable_quilt();
}
v1::AtlasEncoding& encoding(v1::OpenDisplay& open) {
  return *open.mutable_encoding();
}

v1::StereoDisplay& stereo(v1::OpenDisplay& open) {
  v1::StereoDisplay& display = *open.mutable_display()->mutable_stereo();
  display.mutable_eye_size()->set_width(8);
  display.mutable_eye_size()->set_height(8);
  return display;
}

v1::CamerasDisplay& cameras(v1::OpenDisplay& open, int count) {
  v1::CamerasDisplay& display = *open.mutable_display()->mutable_cameras();
  display.mutable_tile_size()->set_width(8);
  display.mutable_tile_size()->set_height(8);
  for (int i = 0; i < count; ++i) {
    v1::Intrinsics& intrinsics = *display.add_cameras()->mutable_intrinsics();
    intrinsics.set_focal_x_px(8);
    intrinsics.set_focal_y_px(8);
  }
  return display;
}

v1::CamerasDisplay& grid(v1::OpenDisplay& open, uint32_t columns, uint32_t rows) {
  v1::CamerasDisplay& display = cameras(open, 0);
  display.mutable_grid()->set_columns(columns);
  display.mutable_grid()->set_rows(rows);
  return display;
}

const std::string kQuilt = "open.display.quilt.";
const std::string kStereo = "open.display.stereo.";
const std::string kCameras = "open.display.cameras.";

const std::vector<BadDisplay> kQuilts = {
    {"no kind", [](auto& o) { o.clear_display(); }, {kInvalid, "open.display.kind"}},
    {"0 columns", [](auto& o) { quilt(o).set_columns(0); }, {kInvalid, kQuilt + "columns"}},
    {"51 columns", [](auto& o) { quilt(o).set_columns(51); }, {kInvalid, kQuilt + "columns"}},
    {"0 rows", [](auto& o) { quilt(o).set_rows(0); }, {kInvalid, kQuilt + "rows"}},
    {"4294967295 rows", [](auto& o) { quilt(o).set_rows(~0u); }, {kInvalid, kQuilt + "rows"}},
    {"no size", [](auto& o) { quilt(o).clear_size(); }, {kInvalid, kQuilt + "size"}},
    {"beyond 16384",
     [](auto& o) { quilt(o).mutable_size()->set_height(16385); },
     {kInvalid, kQuilt + "size.height"}},
    {"tiles of no pixel",
     [](auto& o) { quilt(o).mutable_size()->set_width(1); },
     {kInvalid, kQuilt + "size.width"}},
    {"aspect NaN", [](auto& o) { quilt(o).set_aspect(kNan); }, {kInvalid, kQuilt + "aspect"}},
    {"aspect 21", [](auto& o) { quilt(o).set_aspect(21); }, {kInvalid, kQuilt + "aspect"}},
    {"a cone of 3 rad",
     [](auto& o) { quilt(o).set_view_cone_rad(3); },
     {kInvalid, kQuilt + "view_cone_rad"}},
    {"focus behind",
     [](auto& o) { quilt(o).set_focal_distance_m(-1); },
     {kInvalid, kQuilt + "focal_distance_m"}},
    {"focus NaN",
     [](auto& o) { quilt(o).set_focal_distance_m(kNan); },
     {kInvalid, kQuilt + "focal_distance_m"}},
    {"field of view 3",
     [](auto& o) { quilt(o).set_fov_y_rad(3); },
     {kInvalid, kQuilt + "fov_y_rad"}},
    {"convention 99",
     [](auto& o) { quilt(o).set_convention(static_cast<v1::CameraConvention>(99)); },
     {kInvalid, kQuilt + "convention"}},
    {"depthiness 5",
     [](auto& o) { quilt(o).set_depthiness(5); },
     {kInvalid, kQuilt + "depthiness"}},
    {"a cone that goes round",
     [](auto& o) {
       quilt(o).set_view_cone_rad(2);
       quilt(o).set_depthiness(2);
     },
     {kInvalid, kQuilt + "depthiness"}},
    {"more views than tiles",
     [](auto& o) { quilt(o).set_view_count(3); },
     {kInvalid, kQuilt + "view_count"}},
    {"order 99",
     [](auto& o) { quilt(o).set_order(static_cast<v1::TileOrder>(99)); },
     {kInvalid, kQuilt + "order"}},
    {"no such preset",
     [](auto& o) { quilt(o).set_preset("hologram"); },
     {kMissing, kQuilt + "preset"}},
};

const std::vector<BadDisplay> kOtherKinds = {
    {"no eye size", [](auto& o) { stereo(o).clear_eye_size(); }, {kInvalid, kStereo + "eye_size"}},
    {"eyes 11 m apart",
     [](auto& o) { stereo(o).set_eye_distance_m(11); },
     {kInvalid, kStereo + "eye_distance_m"}},
    {"three eyes",
     [](auto& o) {
       for (int i = 0; i < 3; ++i) stereo(o).add_eyes()->mutable_intrinsics()->set_focal_x_px(1);
     },
     {kInvalid, kStereo + "eyes"}},
    {"two eyes of no height",
     [](auto& o) {
       for (int i = 0; i < 2; ++i) stereo(o).add_eyes()->mutable_intrinsics()->set_focal_x_px(1);
     },
     {kInvalid, kStereo + "eyes[0].intrinsics.focal_y_px"}},
    {"eyes without projection",
     [](auto& o) {
       for (int i = 0; i < 2; ++i) stereo(o).add_eyes();
     },
     {kInvalid, kStereo + "eyes[0].projection"}},
    {"given and tracked eyes",
     [](auto& o) {
       for (int eye = 0; eye < 2; ++eye) {
         v1::Intrinsics& intrinsics = *stereo(o).add_eyes()->mutable_intrinsics();
         intrinsics.set_focal_x_px(8);
         intrinsics.set_focal_y_px(8);
       }
       stereo(o).set_tracked(true);
     },
     {kInvalid, kStereo + "eyes"}},
    {"stereo layout 99",
     [](auto& o) { stereo(o).set_layout(static_cast<v1::StereoLayout>(99)); },
     {kInvalid, kStereo + "layout"}},
    {"no camera", [](auto& o) { cameras(o, 0); }, {kInvalid, kCameras + "cameras"}},
    {"1025 cameras", [](auto& o) { cameras(o, 1025); }, {kInvalid, kCameras + "cameras"}},
    {"no tile size",
     [](auto& o) { cameras(o, 1).clear_tile_size(); },
     {kInvalid, kCameras + "tile_size"}},
    {"4294967295 columns",
     [](auto& o) { cameras(o, 1).set_columns(~0u); },
     {kInvalid, kCameras + "columns"}},
    {"an atlas beyond any JPEG",
     [](auto& o) { cameras(o, 1024).mutable_tile_size()->set_width(8192); },
     {grpc::StatusCode::RESOURCE_EXHAUSTED, kCameras + "tile_size"}},
    {"a grid beside cameras",
     [](auto& o) {
       v1::Intrinsics& one = *grid(o, 2, 2).add_cameras()->mutable_intrinsics();
       one.set_focal_x_px(1);
       one.set_focal_y_px(1);
     },
     {kInvalid, kCameras + "grid"}},
    {"a grid without rows", [](auto& o) { grid(o, 2, 0); }, {kInvalid, kCameras + "grid.rows"}},
    {"a grid of 1025", [](auto& o) { grid(o, 205, 5); }, {kInvalid, kCameras + "grid"}},
    {"a grid at NaN",
     [](auto& o) { grid(o, 2, 2).mutable_grid()->set_spacing_x_m(kNan); },
     {kInvalid, kCameras + "grid.spacing_x_m"}},
    {"five views in a quad",
     [](auto& o) { cameras(o, 5).set_arrangement(v1::TILE_ARRANGEMENT_QUAD_2X2); },
     {kInvalid, kCameras + "arrangement"}},
    {"a row in two columns",
     [](auto& o) {
       cameras(o, 5).set_arrangement(v1::TILE_ARRANGEMENT_ROW);
       cameras(o, 0).set_columns(2);
     },
     {kInvalid, kCameras + "columns"}},
    {"arrangement 99",
     [](auto& o) { cameras(o, 1).set_arrangement(static_cast<v1::TileArrangement>(99)); },
     {kInvalid, kCameras + "arrangement"}},
    {"a camera at NaN",
     [](auto& o) {
       v1::Camera& second = *cameras(o, 2).mutable_cameras(1);
       second.mutable_pose()->mutable_position()->set_y(kNan);
     },
     {kInvalid, kCameras + "cameras[1].pose.position"}},
};

const std::vector<BadDisplay> kCommon = {
    {"a long quaternion",
     [](auto& o) { o.mutable_display()->mutable_world_pose()->mutable_orientation()->set_x(2); },
     {kInvalid, "open.display.world_pose.orientation"}},
    {"tolerance -1",
     [](auto& o) { o.mutable_display()->set_tolerance_px(-1); },
     {kInvalid, "open.display.tolerance_px"}},
    {"tolerance NaN",
     [](auto& o) { o.mutable_display()->set_tolerance_px(kNan); },
     {kInvalid, "open.display.tolerance_px"}},
    {"a 25 bit colour",
     [](auto& o) { o.mutable_display()->set_background_rgb(1 << 24); },
     {kInvalid, "open.display.background_rgb"}},
    {"fill 99",
     [](auto& o) { o.mutable_display()->set_outside_fill(static_cast<v1::OutsideFill>(99)); },
     {kInvalid, "open.display.outside_fill"}},
    {"encoding 99",
     [](auto& o) { encoding(o).set_color(static_cast<v1::BandEncoding>(99)); },
     {kInvalid, "open.encoding.color"}},
    {"quality 101",
     [](auto& o) { encoding(o).set_jpeg_quality(101); },
     {kInvalid, "open.encoding.jpeg_quality"}},
    {"chroma 99",
     [](auto& o) { encoding(o).set_chroma(static_cast<v1::ChromaSubsampling>(99)); },
     {kInvalid, "open.encoding.chroma"}},
    {"depth as JPEG",
     [](auto& o) { encoding(o).set_planes(v1::BAND_ENCODING_JPEG); },
     {kInvalid, "open.encoding.planes"}},
    {"depth as video",
     [](auto& o) { encoding(o).set_planes(v1::BAND_ENCODING_H264); },
     {kInvalid, "open.encoding.planes"}},
    {"quantisation 52",
     [](auto& o) { encoding(o).set_video_qp(52); },
     {kInvalid, "open.encoding.video_qp"}},
    {"prediction 99",
     [](auto& o) { encoding(o).set_prediction(static_cast<v1::Prediction>(99)); },
     {kInvalid, "open.encoding.prediction"}},
    {"a client that accepts nothing that there is",
     [](auto& o) {
       encoding(o).clear_color();
       o.add_accepted()->set_color(static_cast<v1::BandEncoding>(99));
     },
     {kInvalid, "open.accepted"}},
    {"a focal plane that follows for an hour",
     [](auto& o) { o.mutable_display()->set_focus_following_s(3600); },
     {kInvalid, "open.display.focus_following_s"}},
    {"a focal plane that follows, of cameras",
     [](auto& o) {
       cameras(o, 2);
       o.mutable_display()->set_focus_following_s(1);
     },
     {kInvalid, "open.display.focus_following_s"}},
    {"17 samples",
     [](auto& o) { o.mutable_display()->mutable_filter()->set_sample_count(17); },
     {kInvalid, "open.display.filter.sample_count"}},
    {"a filter NaN wide",
     [](auto& o) { o.mutable_display()->mutable_filter()->set_width(kNan); },
     {kInvalid, "open.display.filter.width"}},
    {"a path", [](auto& o) { o.set_stream("../etc"); }, {kInvalid, "open.stream"}},
    {"no such stream", [](auto& o) { o.set_stream("absent"); }, {kMissing, "open.stream"}},
};

TEST(StreamAtlases, refusesQuiltsThatCannotBe) {
  expectRefused(kQuilts);
}
TEST(StreamAtlases, refusesOtherDisplaysThatCannotBe) {
  expectRefused(kOtherKinds);
}
TEST(StreamAtlases, refusesSettingsThatCannotBe) {
  expectRefused(kCommon);
}

TEST(StreamAtlases, saysWhichStreamsAndPresetsThereAre) {
  TestServer server;
  Bystander bystander(server);
  TestWatcher lost(server.connect(), smallQuilt("absent"));
  EXPECT_THAT(lost.finish().error_message(), HasSubstr("healthy"));
  v1::OpenDisplay open = smallQuilt("healthy");
  quilt(open).set_preset("hologram");
  TestWatcher wishful(server.connect(), open);
  EXPECT_THAT(wishful.finish().error_message(), HasSubstr("portrait"));
}

}  // namespace
}  // namespace viewloom::rpc_bad_displays_test
