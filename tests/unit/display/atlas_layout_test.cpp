// SPDX-License-Identifier: Apache-2.0
#include "display/atlas_layout.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "display/presets.h"

namespace viewloom::atlas_layout_test {
namespace {

StreamDefaults someStream() {
  StreamDefaults stream;
  stream.source_intrinsics = {.focal_px = {1000, 1000}, .principal_px = {960, 540}};
  stream.source_size_px = {1920, 1080};
  return stream;
}

DisplaySpec completed(const DisplaySpec& spec) {
  absl::StatusOr<DisplaySpec> result = completeDisplaySpec(spec);
  EXPECT_TRUE(result.ok()) << result.status();
  return *result;
}

AtlasLayout layoutOf(const DisplaySpec& spec) {
  absl::StatusOr<AtlasLayout> layout = makeAtlasLayout(completed(spec), someStream());
  EXPECT_TRUE(layout.ok()) << layout.status();
  return *layout;
}

CamerasSpec camerasOf(size_t count, SizePx tile_size_px) {
  CamerasSpec cameras = {.tile_size_px = tile_size_px};
  cameras.cameras.resize(count, {.projection = Intrinsics{{10, 10}, {5, 5}}});
  return cameras;
}

TEST(AtlasLayout, putsViewZeroOfAQuiltBottomLeftAndGoesUp) {
  const AtlasLayout layout = layoutOf({.kind = QuiltSpec{.preset = "portrait"}});
  EXPECT_EQ(layout.tile_size_px, (SizePx{420, 560}));
  EXPECT_EQ(layout.tileOrigin(0).x_px, 0u);
  EXPECT_EQ(layout.tileOrigin(0).y_px, 5u * 560);
  EXPECT_EQ(layout.tileOrigin(7).x_px, 7u * 420);
  EXPECT_EQ(layout.tileOrigin(8).y_px, 4u * 560);
  EXPECT_EQ(layout.tileOrigin(47).x_px, 7u * 420);
  EXPECT_EQ(layout.tileOrigin(47).y_px, 0u);
  EXPECT_EQ(layout.suffix, "_qs8x6a0.75");
  EXPECT_EQ(layout.aspect, 0.75);
}

TEST(AtlasLayout, putsViewZeroTopLeftWhereAsked) {
  const AtlasLayout layout =
      layoutOf({.kind = QuiltSpec{
                    .columns = 3, .rows = 2, .size_px = {30, 20}, .order = TileOrder::kTopLeft}});
  EXPECT_EQ(layout.tileOrigin(0).y_px, 0u);
  EXPECT_EQ(layout.tileOrigin(4).x_px, 10u);
  EXPECT_EQ(layout.tileOrigin(4).y_px, 10u);
}

TEST(AtlasLayout, stacksTheViewsOfAVideo) {
  AtlasLayout layout = layoutOf({.kind = QuiltSpec{.preset = "portrait"}});
  ASSERT_TRUE(stackViews(layout).ok());
  EXPECT_EQ(layout.size_px, (SizePx{840, 12 * 1120}));
  EXPECT_EQ(layout.imageSize(), (SizePx{840, 1120}));
  EXPECT_EQ(layout.image_count, 12u);
  EXPECT_EQ(layout.columns, 2u);
  EXPECT_EQ(layout.rows, 24u);
  for (uint32_t view = 0; view < 48; ++view) {
    const TileOrigin origin = layout.tileOrigin(view);
    EXPECT_EQ(origin.y_px / 1120, view % 12);
    EXPECT_EQ(layout.viewAt(origin.x_px / 420, origin.y_px / 560), view);
  }
  const TileArrangementPx shown = layout.shown();
  EXPECT_EQ(shown.size_px, (SizePx{3360, 3360}));
  EXPECT_EQ(shown.columns, 8u);
  EXPECT_EQ(shown.order, TileOrder::kBottomLeft);
  EXPECT_EQ(shown.image_count, 1u);
}

TEST(AtlasLayout, stacksViewsOfOddSizesWithRoomAroundThem) {
  AtlasLayout layout = layoutOf({.kind = QuiltSpec{.columns = 5, .rows = 1, .size_px = {107, 33}}});
  const Camera camera = layout.views[3].camera;
  ASSERT_TRUE(stackViews(layout).ok());
  EXPECT_EQ(layout.tile_size_px, (SizePx{22, 34}));
  EXPECT_EQ(layout.padding_right_px, 0u);
  EXPECT_EQ(layout.shown().tile_size_px, (SizePx{21, 33}));
  EXPECT_EQ(layout.shown().padding_right_px, 2u);
  EXPECT_EQ(layout.views[3].camera.intrinsics.principal_px, camera.intrinsics.principal_px);
}

TEST(AtlasLayout, leavesTheRemainderAtTheRightAndTheTop) {
  const AtlasLayout layout =
      layoutOf({.kind = QuiltSpec{.columns = 5, .rows = 9, .size_px = {4096, 4097}}});
  EXPECT_EQ(layout.tile_size_px, (SizePx{819, 455}));
  EXPECT_EQ(layout.padding_right_px, 1u);
  EXPECT_EQ(layout.padding_top_px, 2u);
  EXPECT_EQ(layout.tileOrigin(0).y_px + 455, 4097u);  // the bottom row ends with the atlas
  EXPECT_EQ(layout.tileOrigin(44).y_px, 2u);
}

TEST(AtlasLayout, findsEveryViewAtItsOrigin) {
  for (const TileOrder order : {TileOrder::kBottomLeft, TileOrder::kTopLeft}) {
    const AtlasLayout layout = layoutOf(
        {.kind = QuiltSpec{
             .columns = 4, .rows = 3, .size_px = {41, 32}, .order = order, .view_count = 10}});
    std::vector<uint32_t> seen;
    for (uint32_t row = 0; row < 3; ++row) {
      for (uint32_t column = 0; column < 4; ++column) {
        const uint32_t view = layout.viewAt(column, row);
        seen.push_back(view);
        if (view == 10) continue;
        EXPECT_EQ(layout.tileOrigin(view).x_px, column * 10);
        EXPECT_EQ(layout.tileOrigin(view).y_px, 2 + row * 10);
      }
    }
    EXPECT_THAT(seen, testing::UnorderedElementsAre(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 10));
  }
}

TEST(AtlasLayout, knowsNoViewOutsideTheGrid) {
  const AtlasLayout layout = layoutOf({.kind = camerasOf(5, {10, 10})});
  EXPECT_EQ(layout.columns, 3u);
  EXPECT_EQ(layout.rows, 2u);
  EXPECT_EQ(layout.viewAt(1, 1), 4u);
  EXPECT_EQ(layout.viewAt(2, 1), 5u);
  EXPECT_EQ(layout.viewAt(3, 0), 5u);
  EXPECT_EQ(layout.viewAt(0, 2), 5u);
}

TEST(AtlasLayout, stacksStereoAsAsked) {
  StereoSpec stereo = {.eye_size_px = {640, 360}};
  EXPECT_EQ(layoutOf({.kind = stereo}).size_px, (SizePx{1280, 360}));
  EXPECT_EQ(layoutOf({.kind = stereo}).tileOrigin(1).x_px, 640u);
  stereo.layout = StereoLayout::kTopBottom;
  EXPECT_EQ(layoutOf({.kind = stereo}).size_px, (SizePx{640, 720}));
  EXPECT_EQ(layoutOf({.kind = stereo}).tileOrigin(1).y_px, 360u);
}

TEST(AtlasLayout, ofEveryPresetHoldsAllItsViews) {
  for (const Preset& preset : allPresets()) {
    const AtlasLayout layout = layoutOf({.kind = QuiltSpec{.preset = std::string(preset.name)}});
    EXPECT_EQ(layout.views.size(), preset.columns * preset.rows) << preset.name;
    EXPECT_EQ(layout.size_px, preset.size_px) << preset.name;
    EXPECT_EQ(layout.aspect, preset.aspect) << preset.name;
  }
}

TEST(AtlasLimits, refuseTooWideTooLargeAndTooManyNamingTheField) {
  const DisplaySpec spec = completed({.kind = QuiltSpec{.preset = "portrait"}});
  EXPECT_TRUE(validateAtlasLimits(spec, AtlasLimits{}).ok());
  for (const AtlasLimits& limits :
       {AtlasLimits{.side_px_max = 3359}, AtlasLimits{.area_px_max = 3360 * 3360 - 1},
        AtlasLimits{.view_count_max = 47}}) {
    const absl::Status status = validateAtlasLimits(spec, limits);
    EXPECT_EQ(status.code(), absl::StatusCode::kResourceExhausted);
    EXPECT_EQ(fieldOf(status), "quilt.size");
  }
  EXPECT_TRUE(validateAtlasLimits(
                  spec, {.side_px_max = 3360, .area_px_max = 3360 * 3360, .view_count_max = 48})
                  .ok());
}

TEST(AtlasLimits, refuseWhatNoJpegHoldsWithoutOverflow) {
  DisplaySpec spec{.kind = camerasOf(1024, {8192, 8192})};
  std::get<CamerasSpec>(spec.kind).columns = 1024;
  const absl::Status status = completeDisplaySpec(spec).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kResourceExhausted);
  EXPECT_EQ(fieldOf(status), "cameras.tile_size");
}

TEST(BandRowCount, isEightMcuRows) {
  EXPECT_EQ(bandRowCount({}), 128u);
  EXPECT_EQ(bandRowCount({.chroma = Chroma::k444}), 64u);
  EXPECT_EQ(bandRowCount({.color = BandEncoding::kRaw, .chroma = Chroma::k444}), 128u);
}

}  // namespace
}  // namespace viewloom::atlas_layout_test
