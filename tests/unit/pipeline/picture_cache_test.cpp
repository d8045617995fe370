// SPDX-License-Identifier: Apache-2.0
#include "pipeline/picture_cache.h"

#include <gtest/gtest.h>

#include <cmath>

namespace viewloom::picture_cache_test {
namespace {

// Stands still in the world, so that a camera that moves sees it from elsewhere.
ActiveDisplay someDisplay() {
  QuiltSpec quilt;
  quilt.columns = 2;
  quilt.rows = 2;
  quilt.size_px = {64, 64};
  quilt.view_cone_rad = 0.5;
  ActiveDisplay display;
  display.spec = *completeDisplaySpec({.kind = quilt, .world_pose = Pose{}});
  display.picture_key = "quilt";
  return display;
}

ResidentStructure seenFrom(double x_m) {
  ResidentStructure structure;
  const Camera camera{.pose = {.position_m = {x_m, 0, 0}},
                      .intrinsics = {.focal_px = {50, 50}, .principal_px = {32, 32}}};
  structure.sources = {{camera, {64, 64}}};
  structure.defaults = {
      .source_intrinsics = camera.intrinsics, .source_size_px = {64, 64}, .focal_distance_m = 2};
  return structure;
}

class PictureCacheTest : public ::testing::Test {
 protected:
  PicturePtr get(const ResidentStructure& source) {
    absl::StatusOr<PicturePtr> picture = cache_.get(display_, source, {source.sources, {}});
    EXPECT_TRUE(picture.ok()) << picture.status();
    return picture.value_or(nullptr);
  }

  const ActiveDisplay display_ = someDisplay();
  PictureCache cache_{{}};
};

TEST_F(PictureCacheTest, aCameraThatStandsStillKeepsItsPicture) {
  EXPECT_EQ(get(seenFrom(0)), get(seenFrom(0)));
}

TEST_F(PictureCacheTest, viewsOfAVideoLieInAStackOfPictures) {
  ActiveDisplay display = someDisplay();
  display.encoding.color = BandEncoding::kH264;
  const ResidentStructure source = seenFrom(0);
  const auto picture = cache_.get(display, source, {source.sources, {}});
  ASSERT_TRUE(picture.ok()) << picture.status();
  const AtlasLayout& layout = *(*picture)->layout;
  ASSERT_TRUE(layout.stack.has_value());
  EXPECT_EQ(layout.image_count, 4u);
  EXPECT_EQ(layout.size_px, (SizePx{32, 4 * 32}));
  EXPECT_EQ(layout.shown().size_px, (SizePx{64, 64}));
  EXPECT_EQ((*picture)->tiles.size(), 4u);
}

TEST_F(PictureCacheTest, aCameraThatMovesKeepsTheLayoutAndAimsTheViewsAnew) {
  const PicturePtr before = get(seenFrom(0));
  const float eye_before = before->tiles.front().eye.x;
  const PicturePtr after = get(seenFrom(0.25));
  EXPECT_EQ(before->layout, after->layout);
  // 0.25 m to the right, the views move to the left by as much: focal length times that, px * m.
  EXPECT_NEAR(after->tiles.front().eye.x - eye_before, -50 * 0.25, 1e-4);
}

TEST_F(PictureCacheTest, aPictureInUseStaysAsItIs) {
  const PicturePtr held = get(seenFrom(0));
  const abi::ViewParams view = held->tiles.front();
  get(seenFrom(0.25));
  get(seenFrom(0.5));
  EXPECT_EQ(held->tiles.front().eye, view.eye);
  EXPECT_EQ(get(seenFrom(0))->tiles.front().eye, view.eye);
}

TEST_F(PictureCacheTest, aPictureThatWasLetGoIsUsedAgain) {
  const TraceJob* first = get(seenFrom(0)).get();
  EXPECT_EQ(get(seenFrom(0.25)).get(), first);
}

TEST_F(PictureCacheTest, aDisplayThatLeavesTheSourcesPlaceIsAimedAnew) {
  const auto seenAt = [&](double display_m) {
    const ResidentStructure source = seenFrom(0.5);
    return *cache_.get(display_, source, {source.sources, {.position_m = {display_m, 0, 0}}});
  };
  const float in_place = seenAt(0.5)->tiles.front().eye.x;
  const PicturePtr carried = seenAt(0.75);
  EXPECT_NEAR(carried->tiles.front().eye.x - in_place, 50 * 0.25, 1e-4);
  EXPECT_EQ(seenAt(0.75), carried);
  EXPECT_FLOAT_EQ(seenAt(0.5)->tiles.front().eye.x, in_place);
}

TEST_F(PictureCacheTest, anotherLensMakesAnotherLayout) {
  const PicturePtr before = get(seenFrom(0));
  ResidentStructure zoomed = seenFrom(0);
  zoomed.sources.front().camera.intrinsics.focal_px = {80, 80};
  zoomed.defaults.source_intrinsics = zoomed.sources.front().camera.intrinsics;
  const PicturePtr after = get(zoomed);
  EXPECT_NE(before->layout, after->layout);
  EXPECT_NE(before->layout->views.front().camera.intrinsics,
            after->layout->views.front().camera.intrinsics);
}

TEST_F(PictureCacheTest, aimsAtEverySource) {
  ResidentStructure two = seenFrom(0);
  two.sources.push_back(seenFrom(0.5).sources.front());
  const PicturePtr both = get(two);
  ASSERT_EQ(both->walk_count, 2U);
  ASSERT_EQ(both->tiles.size(), 2 * get(seenFrom(0))->tiles.size());
  EXPECT_GT(both->tilesOf(0)[0].eye.x, both->tilesOf(1)[0].eye.x);
  two.sources[1].camera.pose.position_m.x = 1;
  const PicturePtr moved = get(two);
  EXPECT_EQ(moved->tilesOf(0)[0].eye.x, both->tilesOf(0)[0].eye.x);
  EXPECT_LT(moved->tilesOf(1)[0].eye.x, both->tilesOf(1)[0].eye.x);
}

TEST_F(PictureCacheTest, seesByTheEyesThatItIsGiven) {
  ActiveDisplay tracked;
  tracked.spec =
      *completeDisplaySpec({.kind = StereoSpec{.eye_size_px = {64, 64}, .is_tracked = true}});
  tracked.picture_key = "stereo";
  const auto eyesAt = [](double x_m) {
    auto poses = std::make_shared<EyePoses>();
    poses->eyes[0].pose.position_m = {x_m, 0, 0};
    poses->eyes[1].pose.position_m = {x_m + 0.06, 0, 0};
    return poses;
  };
  const PicturePtr without = *cache_.get(tracked, seenFrom(0), {seenFrom(0).sources, {}});
  const EyePosesPtr right = eyesAt(0.5);
  const PicturePtr moved = *cache_.get(tracked, seenFrom(0), {seenFrom(0).sources, {}}, right);
  EXPECT_FLOAT_EQ(without->tiles[0].eye.x, float(50 * -0.0315));
  EXPECT_FLOAT_EQ(moved->tiles[0].eye.x, float(50 * 0.5));
  EXPECT_EQ(moved->layout->views[1].camera.pose.position_m.x, 0.56);
  EXPECT_EQ(*cache_.get(tracked, seenFrom(0), {seenFrom(0).sources, {}}, right), moved);
  EXPECT_EQ(
      fieldOf(cache_.get(tracked, seenFrom(0), {seenFrom(0).sources, {}}, eyesAt(-1e200)).status()),
      "eye_poses.eyes[0].pose.position");
  EXPECT_EQ(*cache_.get(tracked, seenFrom(0), {seenFrom(0).sources, {}}, right), moved)
      << "after eyes that were refused";
}

TEST_F(PictureCacheTest, followsWhatFramesShowOncePerFrameAndOnlyAsFarAsItShows) {
  ActiveDisplay following = display_;
  following.spec.focus_following_s = 2;
  following.picture_key = "following";
  ResidentStructure frame = seenFrom(0);
  const auto show = [&](double time_s, double inv_z) {
    frame.built_at_ns = int64_t(time_s * 1e9);
    frame.depths = {{.inv_z_low = inv_z - 0.001, .inv_z_high = inv_z + 0.001, .count = 9}};
    frame.stats.inv_z_min = inv_z - 0.001;
    frame.stats.inv_z_max = inv_z + 0.001;
    return *cache_.get(following, frame, {frame.sources, {}});
  };
  const PicturePtr first = show(10, 1.5);
  EXPECT_EQ(first->layout->focal_distance_m, 2);
  EXPECT_EQ(show(10, 1.5), first);
  const PicturePtr second = show(11, 1.5);
  EXPECT_NEAR(1 / second->layout->focal_distance_m, 1.5 - std::exp(-0.5), 1e-9);
  EXPECT_EQ(second->layout->eye_focus_m, second->layout->focal_distance_m);
  // For another encoding of the same frame.
  EXPECT_EQ(show(11, 1.5), second);
  // At rest, nothing is laid out, and a source without surface says nothing.
  const PicturePtr third = show(60, 1.5);
  EXPECT_NEAR(1 / third->layout->focal_distance_m, 1.5, 1e-9);
  EXPECT_EQ(show(70, 1.5), third);
  frame.built_at_ns += 10'000'000'000;
  frame.depths.clear();
  EXPECT_EQ(*cache_.get(following, frame, {frame.sources, {}}), third);
  // The display without stays.
  EXPECT_EQ((*cache_.get(display_, frame, {frame.sources, {}}))->layout->focal_distance_m, 2);
}

TEST_F(PictureCacheTest, forgetsWhatNobodyShows) {
  const PicturePtr before = get(seenFrom(0));
  cache_.keepOnly({});
  EXPECT_NE(get(seenFrom(0)), before);
}

}  // namespace
}  // namespace viewloom::picture_cache_test
