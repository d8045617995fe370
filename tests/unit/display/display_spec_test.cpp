// SPDX-License-Identifier: Apache-2.0
#include "display/display_spec.h"

#include <functional>
#include <limits>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "display/presets.h"

namespace viewloom::display_spec_test {
namespace {

using testing::HasSubstr;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

QuiltSpec goodQuilt() {
  return {.columns = 8, .rows = 6, .size_px = {3360, 3360}};
}
StereoSpec goodStereo() {
  return {.eye_size_px = {640, 480}};
}
CamerasSpec goodCameras() {
  return {.cameras = {{.projection = Intrinsics{{100, 100}, {50, 50}}}},
          .tile_size_px = {100, 100}};
}

struct BadSpec {
  std::string field;
  std::function<DisplaySpec()> make;
};

template <typename Kind, typename Change>
std::function<DisplaySpec()> changed(Kind kind, Change change) {
  return [=]() mutable {
    change(kind);
    return DisplaySpec{.kind = kind};
  };
}

template <typename Change>
std::function<DisplaySpec()> changedDisplay(Change change) {
  return [=] {
    DisplaySpec spec{.kind = goodQuilt()};
    change(spec);
    return spec;
  };
}

std::vector<BadSpec> badQuilts() {
  using Q = QuiltSpec;
  return {
      {"quilt.columns", changed(goodQuilt(), [](Q& q) { q.columns = 0; })},
      {"quilt.columns", changed(goodQuilt(), [](Q& q) { q.columns = 51; })},
      {"quilt.rows", changed(goodQuilt(), [](Q& q) { q.rows = 0; })},
      {"quilt.rows", changed(goodQuilt(), [](Q& q) { q.rows = 0xFFFFFFFF; })},
      {"quilt.size", changed(goodQuilt(), [](Q& q) { q.size_px = {}; })},
      {"quilt.size.width", changed(goodQuilt(), [](Q& q) { q.size_px.width = 0; })},
      {"quilt.size.width", changed(goodQuilt(), [](Q& q) { q.size_px.width = 16385; })},
      {"quilt.size.width", changed(goodQuilt(), [](Q& q) { q.size_px.width = 7; })},
      {"quilt.size.height", changed(goodQuilt(), [](Q& q) { q.size_px.height = 0; })},
      {"quilt.size.height", changed(goodQuilt(), [](Q& q) { q.size_px.height = 5; })},
      {"quilt.aspect", changed(goodQuilt(), [](Q& q) { q.aspect = 0.04; })},
      {"quilt.aspect", changed(goodQuilt(), [](Q& q) { q.aspect = -1; })},
      {"quilt.aspect", changed(goodQuilt(), [](Q& q) { q.aspect = 21; })},
      {"quilt.aspect", changed(goodQuilt(), [](Q& q) { q.aspect = kNan; })},
      {"quilt.view_cone_rad", changed(goodQuilt(), [](Q& q) { q.view_cone_rad = 2.61; })},
      {"quilt.view_cone_rad", changed(goodQuilt(), [](Q& q) { q.view_cone_rad = -0.1; })},
      {"quilt.view_cone_rad", changed(goodQuilt(), [](Q& q) { q.view_cone_rad = kNan; })},
      {"quilt.focal_distance_m", changed(goodQuilt(), [](Q& q) { q.focal_distance_m = -1; })},
      {"quilt.focal_distance_m", changed(goodQuilt(), [](Q& q) { q.focal_distance_m = kInf; })},
      {"quilt.focal_distance_m", changed(goodQuilt(), [](Q& q) { q.focal_distance_m = 1e-9; })},
      {"quilt.fov_y_rad", changed(goodQuilt(), [](Q& q) { q.fov_y_rad = 3; })},
      {"quilt.view_count", changed(goodQuilt(), [](Q& q) { q.view_count = 49; })},
  };
}

std::vector<BadSpec> badOthers() {
  using S = StereoSpec;
  using C = CamerasSpec;
  using D = DisplaySpec;
  return {
      {"stereo.eye_size.width", changed(goodStereo(), [](S& s) { s.eye_size_px.width = 0; })},
      {"stereo.eye_size.height", changed(goodStereo(), [](S& s) { s.eye_size_px.height = 8193; })},
      {"stereo.eye_distance_m", changed(goodStereo(), [](S& s) { s.eye_distance_m = -0.06; })},
      {"stereo.eye_distance_m", changed(goodStereo(), [](S& s) { s.eye_distance_m = 11; })},
      {"stereo.focal_distance_m", changed(goodStereo(), [](S& s) { s.focal_distance_m = kNan; })},
      {"stereo.fov_y_rad", changed(goodStereo(), [](S& s) { s.fov_y_rad = -1; })},
      {"stereo.eyes", changed(goodStereo(), [](S& s) { s.eyes = {goodCameras().cameras[0]}; })},
      {"cameras.cameras", changed(goodCameras(), [](C& c) { c.cameras.clear(); })},
      {"cameras.cameras",
       changed(goodCameras(), [](C& c) { c.cameras.resize(1025, c.cameras[0]); })},
      {"cameras.tile_size", changed(goodCameras(), [](C& c) { c.tile_size_px = {}; })},
      {"cameras.columns", changed(goodCameras(), [](C& c) { c.columns = 1025; })},
      {"tolerance_px", changedDisplay([](D& d) { d.tolerance_px = -1; })},
      {"tolerance_px", changedDisplay([](D& d) { d.tolerance_px = 17; })},
      {"tolerance_px", changedDisplay([](D& d) { d.tolerance_px = kNan; })},
      {"background_rgb", changedDisplay([](D& d) { d.background_rgb = 0x1000000; })},
  };
}

TEST(CompleteDisplaySpec, refusesEachFieldOutOfRangeByItsName) {
  std::vector<BadSpec> specs = badQuilts();
  for (BadSpec& other : badOthers()) specs.push_back(std::move(other));
  for (const BadSpec& bad : specs) {
    const absl::Status status = completeDisplaySpec(bad.make()).status();
    EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument) << bad.field;
    EXPECT_EQ(fieldOf(status), bad.field) << status;
    EXPECT_THAT(std::string(status.message()), HasSubstr("accepted is")) << bad.field;
  }
}

TEST(CompleteDisplaySpec, refusesAWorldPoseThatIsNone) {
  DisplaySpec spec{.kind = goodQuilt(), .world_pose = Pose{}};
  spec.world_pose->orientation = {0, 0, 0, 0.5};
  EXPECT_THAT(fieldOf(completeDisplaySpec(spec).status()), testing::StartsWith("world_pose"));
}

TEST(CompleteDisplaySpec, listsThePresetsThatExistWhenOneDoesNot) {
  const absl::Status status =
      completeDisplaySpec({.kind = QuiltSpec{.preset = "portrit"}}).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kNotFound);
  EXPECT_EQ(fieldOf(status), "quilt.preset");
  for (const Preset& preset : allPresets()) {
    EXPECT_THAT(std::string(status.message()), HasSubstr(std::string(preset.name)));
  }
}

TEST(CompleteDisplaySpec, letsFieldsOverrideTheirPreset) {
  const auto spec = completeDisplaySpec(
      {.kind = QuiltSpec{.preset = "go_p", .size_px = {1024, 1024}, .view_cone_rad = 0.5}});
  ASSERT_TRUE(spec.ok()) << spec.status();
  const auto& quilt = std::get<QuiltSpec>(spec->kind);
  EXPECT_EQ(quilt.columns, 11u);
  EXPECT_EQ(quilt.rows, 6u);
  EXPECT_EQ(quilt.size_px, (SizePx{1024, 1024}));
  EXPECT_EQ(quilt.aspect, 0.5625);
  EXPECT_EQ(quilt.view_cone_rad, 0.5);
  EXPECT_EQ(quilt.view_count, 66u);
}

TEST(CompleteDisplaySpec, fillsInTheDefaultsOfTheProto) {
  const auto quilt = completeDisplaySpec({.kind = goodQuilt()});
  ASSERT_TRUE(quilt.ok());
  EXPECT_DOUBLE_EQ(std::get<QuiltSpec>(quilt->kind).view_cone_rad, 40 * std::numbers::pi / 180);
  EXPECT_EQ(quilt->tolerance_px, 0.25);
  const auto stereo = completeDisplaySpec({.kind = goodStereo()});
  EXPECT_EQ(std::get<StereoSpec>(stereo->kind).eye_distance_m, 0.063);
  CamerasSpec seven = goodCameras();
  seven.cameras.resize(7, seven.cameras[0]);
  EXPECT_EQ(std::get<CamerasSpec>(completeDisplaySpec({.kind = seven})->kind).columns, 3u);
}

TEST(CompleteDisplaySpec, changesNothingOnASecondPass) {
  const auto once = completeDisplaySpec({.kind = QuiltSpec{.preset = "portrait"}});
  const auto twice = completeDisplaySpec(*once);
  EXPECT_EQ(displayKey(*once), displayKey(*twice));
}

TEST(CompleteDisplaySpec, changesNoPanelOnASecondPass) {
  for (const DisplaySpec& spec : {DisplaySpec{.kind = LenticularSpec{.preset = "16_gen3_l"}},
                                  DisplaySpec{.kind = IntegralSpec{.preset = "near_eye_2013"}}}) {
    const auto once = completeDisplaySpec(spec);
    ASSERT_TRUE(once.ok()) << once.status();
    const auto twice = completeDisplaySpec(*once);
    ASSERT_TRUE(twice.ok()) << twice.status();
    EXPECT_EQ(displayKey(*once), displayKey(*twice));
  }
}

TEST(ValidateEncodingSpec, refusesWhatNoEncoderDoes) {
  EXPECT_TRUE(validateEncodingSpec({}).ok());
  EXPECT_EQ(fieldOf(validateEncodingSpec({.jpeg_quality = 0})), "jpeg_quality");
  EXPECT_EQ(fieldOf(validateEncodingSpec({.jpeg_quality = 101})), "jpeg_quality");
  EXPECT_EQ(fieldOf(validateEncodingSpec({.planes = BandEncoding::kJpeg})), "planes");
  EXPECT_TRUE(
      validateEncodingSpec({.with_depth = true, .planes = BandEncoding::kCompactDepth}).ok());
  EXPECT_EQ(fieldOf(validateEncodingSpec(
                {.with_depth = true, .with_mask = true, .planes = BandEncoding::kCompactDepth})),
            "planes");
  EXPECT_EQ(fieldOf(validateEncodingSpec({.color = BandEncoding::kCompactDepth})), "color");
}

TEST(DisplayKey, isTheSameForPanelsThatDifferInTheirSerialNumber) {
  LenticularSpec lenticular{.preset = "portrait"};
  const auto panel = completeDisplaySpec({.kind = lenticular});
  ASSERT_TRUE(panel.ok()) << panel.status();
  Calibration calibration = *std::get<LenticularSpec>(panel->kind).calibration;
  calibration.serial = "LKG-TEST";
  lenticular.calibration_json = writeCalibration(calibration);
  EXPECT_EQ(displayKey(*completeDisplaySpec({.kind = lenticular})), displayKey(*panel));
}

TEST(DisplayKey, isTheSameForAPresetAndItsNumbers) {
  const auto named = completeDisplaySpec({.kind = QuiltSpec{.preset = "portrait"}});
  QuiltSpec numbers = std::get<QuiltSpec>(named->kind);
  numbers.preset.clear();
  EXPECT_EQ(displayKey(*named), displayKey(*completeDisplaySpec({.kind = numbers})));
}

class DifferingKeys : public testing::Test {
 protected:
  void add(const DisplaySpec& spec) {
    const auto completed = completeDisplaySpec(spec);
    ASSERT_TRUE(completed.ok()) << completed.status();
    keys_.push_back(displayKey(*completed));
  }

  void TearDown() override {
    std::ranges::sort(keys_);
    EXPECT_EQ(std::ranges::adjacent_find(keys_), keys_.end());
  }

 private:
  std::vector<std::string> keys_;
};

TEST_F(DifferingKeys, followFromEveryFieldThatChangesThePictureOfAPanel) {
  LenticularSpec lenticular{.preset = "portrait"};
  add({.kind = lenticular});
  lenticular.view_count = 48;
  add({.kind = lenticular});
  lenticular.preset = "go_p";
  add({.kind = lenticular});
  IntegralSpec integral{.preset = "near_eye_2013"};
  add({.kind = integral});
  integral.is_flipped = true;
  add({.kind = integral});
  integral.offset_px.y = 1;
  add({.kind = integral});
}

TEST_F(DifferingKeys, followFromEveryFieldThatChangesThePicture) {
  QuiltSpec quilt = goodQuilt();
  add({.kind = quilt});
  add({.kind = quilt, .world_pose = Pose{}});
  add({.kind = quilt, .tolerance_px = 0.5});
  add({.kind = quilt, .outside_fill = OutsideFill::kBackground});
  add({.kind = quilt, .background_rgb = 1});
  quilt.focal_distance_m = 1;
  add({.kind = quilt});
  quilt.focal_distance_m = std::nextafter(1.0, 2.0);
  add({.kind = quilt});
  quilt.order = TileOrder::kTopLeft;
  add({.kind = quilt});
  quilt.view_count = 7;
  add({.kind = quilt});
  StereoSpec stereo = goodStereo();
  add({.kind = stereo});
  stereo.layout = StereoLayout::kTopBottom;
  add({.kind = stereo});
  CamerasSpec cameras = goodCameras();
  add({.kind = cameras});
  cameras.cameras[0].pose.position_m.z = 1;
  add({.kind = cameras});
  cameras.order = TileOrder::kBottomLeft;
  add({.kind = cameras});
  cameras.arrangement = TileArrangement::kSeparate;
  add({.kind = cameras});
  cameras.cameras.clear();
  cameras.grid = CameraGrid{.columns = 2, .rows = 2};
  add({.kind = cameras});
  cameras.grid->spacing_m.y = 0.5;
  add({.kind = cameras});
  quilt.convention = CameraConvention::kCore;
  add({.kind = quilt});
  quilt.depthiness = 1.5;
  add({.kind = quilt});
  quilt.cone_begin = 0.25;
  add({.kind = quilt});
  add({.kind = quilt, .filter = {.sample_count = 4}});
  add({.kind = quilt, .filter = {.sample_count = 4, .width = 2}});
  stereo.layout = StereoLayout::kSeparate;
  add({.kind = stereo});
}

}  // namespace
}  // namespace viewloom::display_spec_test
