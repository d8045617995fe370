// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "messages/source_from_proto.h"
#include "rpc/layout_to_proto.h"
#include "rpc/report_to_proto.h"
#include "rpc/source_wants.h"
#include "rpc/stream_name.h"

namespace viewloom::to_proto_test {
namespace {

TEST(CameraToProto, comesBackAsItWas) {
  const Camera camera{
      .pose = {.position_m = {1, 2, 3}, .orientation = glm::dquat(0.5, -0.5, 0.5, 0.5)},
      .intrinsics = {.focal_px = {4, 5}, .principal_px = {6, 7}}};
  const v1::Camera proto = cameraToProto(camera);
  EXPECT_EQ(*poseFromProto(proto.pose(), "pose"), camera.pose);
  EXPECT_EQ(std::get<Intrinsics>(*projectionFromProto(proto)), camera.intrinsics);
}

TEST(CoverageToProto, isShares) {
  const v1::Coverage proto =
      coverageToProto({.hit = 5, .hit_assumed = 1, .hidden = 1, .outside = 2, .empty = 1});
  EXPECT_EQ(proto.hit(), 0.5);
  EXPECT_EQ(proto.hit_assumed(), 0.1);
  EXPECT_EQ(proto.hidden(), 0.1);
  EXPECT_EQ(proto.outside(), 0.2);
  EXPECT_EQ(proto.empty(), 0.1);
  EXPECT_EQ(coverageToProto({}).hit(), 0) << "no rays, no shares, no NaN";
}

TEST(BudgetToProto, namesEverything) {
  const v1::DepthBudget proto = budgetToProto({.disparity_max_px = 9,
                                               .beyond_fusing_share = 0.5,
                                               .beyond_ghosting_share = 0.25,
                                               .suggested_focal_distance_m = 2,
                                               .suggested_view_cone_rad = 0.375});
  EXPECT_EQ(proto.disparity_max_px(), 9);
  EXPECT_EQ(proto.beyond_fusing_share(), 0.5);
  EXPECT_EQ(proto.beyond_ghosting_share(), 0.25);
  EXPECT_EQ(proto.suggested_focal_distance_m(), 2);
  EXPECT_EQ(proto.suggested_view_cone_rad(), 0.375);
}

TEST(ReportToProto, carriesStatsOnlyOfWhatWasBuilt) {
  const FrameReport refused{.number = 1, .outcome = FrameOutcome::kRefused, .reason = "why"};
  EXPECT_EQ(reportToProto(refused).outcome(), v1::FRAME_OUTCOME_REFUSED);
  EXPECT_EQ(reportToProto(refused).reason(), "why");
  EXPECT_FALSE(reportToProto(refused).has_stats());
  const FrameReport traced{.number = 2,
                           .outcome = FrameOutcome::kTraced,
                           .displays = {{.display_id = 3, .times = {.trace_ns = 4}}},
                           .stats = {.noise_sigma = 5, .inv_z_max = 6}};
  const v1::FrameReport proto = reportToProto(traced);
  EXPECT_EQ(proto.outcome(), v1::FRAME_OUTCOME_TRACED);
  EXPECT_EQ(proto.displays(0).display_id(), 3u);
  EXPECT_EQ(proto.displays(0).times().trace_ns(), 4);
  EXPECT_EQ(proto.stats().noise_sigma(), 5);
  EXPECT_EQ(proto.stats().inv_z_max(), 6);
}

TEST(LayoutToProto, namesEverything) {
  const AtlasLayout layout{.size_px = {17, 9},
                           .columns = 2,
                           .rows = 1,
                           .tile_size_px = {8, 9},
                           .order = TileOrder::kBottomLeft,
                           .aspect = 0.75,
                           .padding_right_px = 1,
                           .padding_top_px = 0,
                           .view_cone_rad = 0.7,
                           .focal_distance_m = 2,
                           .suffix = "_qs2x1a0.75",
                           .views = std::vector<View>(2)};
  const v1::AtlasLayout proto = layoutToProto(layout, {.chroma = Chroma::k444});
  EXPECT_EQ(proto.size().width(), 17u);
  EXPECT_EQ(proto.columns(), 2u);
  EXPECT_EQ(proto.rows(), 1u);
  EXPECT_EQ(proto.tile_size().height(), 9u);
  EXPECT_EQ(proto.order(), v1::TILE_ORDER_BOTTOM_LEFT);
  EXPECT_EQ(proto.aspect(), 0.75);
  EXPECT_EQ(proto.view_count(), 2u);
  EXPECT_EQ(proto.padding_right_px(), 1u);
  EXPECT_EQ(proto.view_cone_rad(), 0.7);
  EXPECT_EQ(proto.focal_distance_m(), 2);
  EXPECT_EQ(proto.suffix(), "_qs2x1a0.75");
  EXPECT_EQ(proto.encoding().chroma(), v1::CHROMA_SUBSAMPLING_444);
  EXPECT_EQ(proto.encoding().color(), v1::BAND_ENCODING_JPEG);
  EXPECT_EQ(proto.encoding().planes(), v1::BAND_ENCODING_ZSTD);
  EXPECT_EQ(proto.views_size(), 2);
}

TEST(LayoutToProto, namesTheRungOfVideoThatAdapts) {
  EncodingSpec encoding = {.color = BandEncoding::kH264, .video_qp = 24};
  EXPECT_EQ(layoutToProto({}, encoding).video_rung(), 0u);
  encoding.video_qp_max = 40;
  EXPECT_EQ(layoutToProto({}, encoding).video_rung(), 1u);
  EXPECT_EQ(layoutToProto({}, onOtherRung(encoding)).video_rung(), 2u);
}

// `Wanted` for surfaces at infinity.
v1::Wanted wantedAfar(const std::vector<AtlasPtr>& atlases, uint32_t display_count) {
  return wantedToProto(atlases, std::vector<InvZRange>(atlases.size()), display_count);
}

// Two views of 90 degrees, 10 px wide, turned 20 degrees to the left and to the right.
TEST(WantedToProto, isTheUnionOfWhatViewsSee) {
  const double turn_rad = M_PI / 9;
  auto layout = std::make_shared<AtlasLayout>();
  layout->tile_size_px = {10, 10};
  for (const double side : {-1.0, 1.0}) {
    View view;
    view.camera.intrinsics = {.focal_px = {5, 5}, .principal_px = {5, 5}};
    view.camera.pose.orientation = glm::angleAxis(side * turn_rad, glm::dvec3(0, 1, 0));
    layout->views.push_back(view);
  }
  auto atlas = std::make_shared<EncodedAtlas>();
  atlas->layout = layout;
  const std::vector<AtlasPtr> atlases{atlas};
  const v1::Wanted wanted = wantedAfar(atlases, 1);
  EXPECT_NEAR(wanted.fov().angle_left_rad(), -(M_PI / 4 + turn_rad), 1e-12);
  EXPECT_NEAR(wanted.fov().angle_right_rad(), M_PI / 4 + turn_rad, 1e-12);
  EXPECT_EQ(wanted.layer_count(), 1u) << "no view leaves the source's place";
  // A view is densest in the corners of its inner edge, 25 degrees from the source's axis and 45
  // from its own: there a px of the source to the right is cos^2(25) / cos^2(45) px of the view to
  // the right, and by the turn some up or down.
  const double inner = std::cos(M_PI / 4 - turn_rad);
  const double focal_px =
      5 * std::hypot(2 * inner * inner, std::sqrt(2) * inner * std::sin(turn_rad));
  EXPECT_EQ(wanted.size().width(), std::ceil(focal_px * 2 * std::tan(M_PI / 4 + turn_rad)));
}

// A view beside the source that looks along its axis sees the more to that side the nearer.
TEST(WantedToProto, isOfWhatIsSeenBetweenDepths) {
  auto layout = std::make_shared<AtlasLayout>();
  layout->tile_size_px = {10, 10};
  layout->views.resize(1);
  layout->views[0].camera = {.pose = {.position_m = {0.5, 0, 0}},
                             .intrinsics = {.focal_px = {5, 5}, .principal_px = {5, 5}}};
  auto atlas = std::make_shared<EncodedAtlas>();
  atlas->layout = layout;
  const v1::Wanted wanted = wantedToProto(std::vector<AtlasPtr>{atlas},
                                          std::vector<InvZRange>{{.far = 0.25, .near = 2}}, 1);
  EXPECT_NEAR(std::tan(wanted.fov().angle_right_rad()), 1 + 0.5 * 2, 1e-12);
  EXPECT_NEAR(std::tan(wanted.fov().angle_left_rad()), -1 + 0.5 * 0.25, 1e-12);
}

TEST(WantedToProto, takesTheEyesOfAPanelForThoseOfItsView) {
  auto layout = std::make_shared<AtlasLayout>();
  layout->tile_size_px = layout->size_px = {10, 10};
  layout->views.resize(1);
  layout->views[0].camera.intrinsics = {.focal_px = {5, 5}, .principal_px = {5, 5}};
  layout->eye_focus_m = 2;
  auto atlas = std::make_shared<EncodedAtlas>();
  atlas->layout = layout;
  const std::vector<AtlasPtr> atlases{atlas};
  EXPECT_EQ(wantedAfar(atlases, 1).layer_count(), 1u);
  layout->rays = LenticularRays{.view_cone_rad = 0.6, .distance_m = 2};
  EXPECT_EQ(wantedAfar(atlases, 1).layer_count(), 2u);
  // From half the cone to the left, the panel's right edge lies that much further to the right;
  // samples may lie half a px beyond it.
  EXPECT_NEAR(std::tan(wantedAfar(atlases, 1).fov().angle_right_rad()), 5.5 / 5 + std::tan(0.3),
              1e-9);
}

// Eyes that stand so, of a display in the place of its source.
AtlasPtr atlasOfEyes(const Pose& left, const Pose& right) {
  auto layout = std::make_shared<AtlasLayout>();
  layout->tile_size_px = {10, 10};
  layout->size_px = {20, 10};
  for (const Pose& pose : {left, right}) {
    layout->views.push_back(
        {.camera = {.pose = pose, .intrinsics = {.focal_px = {5, 5}, .principal_px = {5, 5}}}});
  }
  auto atlas = std::make_shared<EncodedAtlas>();
  atlas->layout = std::move(layout);
  atlas->source_camera.pose.position_m = {7, 8, 9};
  atlas->display_pose = atlas->source_camera.pose;
  atlas->eye_poses_latched_ns = 1;
  return atlas;
}

TEST(WantedToProto, standsBetweenTheEyesWhereEveryDisplayFollowsThem) {
  const glm::dquat turn = glm::angleAxis(0.4, glm::dvec3(0, 1, 0));
  // The same turn, written with both signs.
  const AtlasPtr one = atlasOfEyes({.position_m = {1, 0.5, -2}, .orientation = turn},
                                   {.position_m = {1.25, 0.5, -2}, .orientation = -turn});
  const v1::Wanted wanted = wantedAfar({one}, 1);
  EXPECT_NEAR(wanted.pose().position().x(), 1.125, 1e-12);
  EXPECT_NEAR(wanted.pose().position().y(), 0.5, 1e-12);
  EXPECT_NEAR(wanted.pose().position().z(), -2, 1e-12);
  EXPECT_NEAR(std::abs(wanted.pose().orientation().y()), std::sin(0.2), 1e-12);
  EXPECT_NEAR(wanted.fov().angle_right_rad(), M_PI / 4, 1e-9) << "it looks where they look";
  EXPECT_NEAR(wanted.fov().angle_left_rad(), -M_PI / 4, 1e-9);
  EXPECT_EQ(wanted.layer_count(), 2u) << "each eye sees behind what the other does";

  const AtlasPtr other = atlasOfEyes({.position_m = {-1, 0, 0}}, {.position_m = {-0.75, 0, 0}});
  const v1::Wanted of_both = wantedAfar({one, other}, 2);
  EXPECT_NEAR(of_both.pose().position().x(), 0.125, 1e-12);
  EXPECT_GT(of_both.fov().angle_right_rad(), M_PI / 4);

  auto fixed = std::make_shared<EncodedAtlas>(*other);
  fixed->eye_poses_latched_ns = 0;
  const v1::Wanted beside = wantedAfar({one, fixed}, 2);
  EXPECT_EQ(beside.pose().position().x(), 0) << "a display that stands needs the source that is";
  EXPECT_EQ(beside.pose().orientation().w(), 1);
}

TEST(StreamName, isOfLettersDigitsAndThreeSigns) {
  EXPECT_TRUE(validateStreamName("A-z_0.9", "stream").ok());
  EXPECT_TRUE(validateStreamName(std::string(64, 'a'), "stream").ok());
  for (const char* name : {"", "a b", "a/b", "\xc3\xa4", "a\n"}) {
    EXPECT_EQ(fieldOf(validateStreamName(name, "stream")), "stream") << name;
  }
}

}  // namespace
}  // namespace viewloom::to_proto_test
