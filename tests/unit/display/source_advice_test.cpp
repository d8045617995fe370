// SPDX-License-Identifier: Apache-2.0
// Advised sources, judged by projecting random points of the depth range through every view.
#include "display/source_advice.h"

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace viewloom::source_advice_test {
namespace {

constexpr double kNear_m = 1.2;
constexpr double kFar_m = 9;
constexpr double kRounding_px = 1e-6;

DisplaySpec completed(const DisplaySpec& spec) {
  const absl::StatusOr<DisplaySpec> complete = completeDisplaySpec(spec);
  EXPECT_TRUE(complete.ok()) << complete.status();
  return *complete;
}

SourceAdvice adviceFor(const DisplaySpec& spec) {
  const absl::StatusOr<SourceAdvice> advice = adviseSource(completed(spec), kNear_m, kFar_m);
  EXPECT_TRUE(advice.ok()) << advice.status();
  return *advice;
}

// Layout for a scene of this range: its focal plane is the harmonic mean of both ends.
AtlasLayout layoutFor(const DisplaySpec& spec) {
  const StreamDefaults stream{.source_intrinsics = {.focal_px = {1, 1}},
                              .source_size_px = {1, 1},
                              .focal_distance_m = 2 * kNear_m * kFar_m / (kNear_m + kFar_m)};
  const absl::StatusOr<AtlasLayout> layout = makeAtlasLayout(completed(spec), stream);
  EXPECT_TRUE(layout.ok()) << layout.status();
  return *layout;
}

// A textbook pinhole camera. Points behind it fall outside every image.
glm::dvec2 project(const Camera& camera, const glm::dvec3& point_m) {
  const glm::dvec3 p = glm::inverse(camera.pose.orientation) * (point_m - camera.pose.position_m);
  if (p.z >= 0) return glm::dvec2(-1e9);
  return {camera.intrinsics.principal_px.x + camera.intrinsics.focal_px.x * p.x / -p.z,
          camera.intrinsics.principal_px.y - camera.intrinsics.focal_px.y * p.y / -p.z};
}

bool isInside(glm::dvec2 px, SizePx size_px, double margin_px) {
  return px.x >= -margin_px && px.y >= -margin_px && px.x <= size_px.width + margin_px &&
         px.y <= size_px.height + margin_px;
}

// In front of the camera, as deep as the range, half of them at its ends.
std::vector<glm::dvec3> scenePoints(const Camera& camera) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> inv_z(1 / kFar_m, 1 / kNear_m);
  std::uniform_real_distribution<double> tangent(-3, 3);
  std::vector<glm::dvec3> points_m;
  for (int i = 0; i < 60000; ++i) {
    const double z_m = i % 4 == 0 ? kNear_m : i % 4 == 1 ? kFar_m : 1 / inv_z(random);
    const glm::dvec3 in_camera = z_m * glm::dvec3(tangent(random), tangent(random), -1);
    points_m.push_back(camera.pose.orientation * in_camera + camera.pose.position_m);
  }
  return points_m;
}

// How far a px of the source reaches in the view, at a point.
double pxOfSourceIn(const Camera& view, const Camera& source, const glm::dvec3& point_m, int axis) {
  const glm::dvec3 p = glm::inverse(source.pose.orientation) * (point_m - source.pose.position_m);
  glm::dvec3 step_m(0.0);
  constexpr double kPart = 1e-4;
  step_m[axis] = kPart * -p.z / source.intrinsics.focal_px[axis];
  const glm::dvec3 beside_m = point_m + source.pose.orientation * step_m;
  return glm::length(project(view, beside_m) - project(view, point_m)) / kPart;
}

struct Seen {
  uint32_t count = 0;
  // Extremes of the points in the advised image, px.
  glm::dvec2 low_px{1e9};
  glm::dvec2 high_px{-1e9};
  glm::dvec2 coarsest_px{0.0};  // px of a view that a px of the source reaches
};

// Expects the source to see every point that any view sees.
Seen expectToServe(const AdvisedSource& source, const std::vector<Camera>& views, SizePx tile_px) {
  Seen seen;
  for (const glm::dvec3& point_m : scenePoints(source.camera)) {
    for (const Camera& view : views) {
      if (!isInside(project(view, point_m), tile_px, 0)) continue;
      const glm::dvec2 px = project(source.camera, point_m);
      EXPECT_TRUE(isInside(px, source.size_px, kRounding_px)) << px.x << ", " << px.y;
      ++seen.count;
      seen.low_px = glm::min(seen.low_px, px);
      seen.high_px = glm::max(seen.high_px, px);
      for (int axis = 0; axis < 2; ++axis) {
        seen.coarsest_px[axis] =
            std::max(seen.coarsest_px[axis], pxOfSourceIn(view, source.camera, point_m, axis));
      }
    }
  }
  return seen;
}

std::vector<Camera> camerasOf(const AtlasLayout& layout) {
  std::vector<Camera> cameras;
  for (const View& view : layout.views) cameras.push_back(view.camera);
  return cameras;
}

DisplaySpec quilt(double view_cone_rad) {
  return {.kind = QuiltSpec{.columns = 5,
                            .rows = 1,
                            .size_px = {5 * 300, 400},
                            .view_cone_rad = view_cone_rad,
                            .fov_y_rad = 0.6}};
}

DisplaySpec arcOfCameras() {
  CamerasSpec cameras{.tile_size_px = {300, 200}};
  for (int i = -2; i <= 2; ++i) {
    const glm::dquat turned = glm::angleAxis(0.2 * i, glm::dvec3(0, 1, 0));
    cameras.cameras.push_back(
        {.pose = {.position_m = turned * glm::dvec3(0, 0.1 * i, 0.5), .orientation = turned},
         .projection = Intrinsics{{250, 240}, {140, 110}}});
  }
  return {.kind = cameras};
}

TEST(SourceAdvice, seesAllThatAnyViewOfAQuiltSees) {
  const AtlasLayout layout = layoutFor(quilt(0.7));
  const SourceAdvice advice = adviceFor(quilt(0.7));
  const Seen seen = expectToServe(advice.source, camerasOf(layout), layout.tile_size_px);
  EXPECT_GT(seen.count, 1000u);
  // And little more: within the reach of so many random points.
  const glm::dvec2 size_px(advice.source.size_px.width, advice.source.size_px.height);
  EXPECT_LT(seen.low_px.x, 0.05 * size_px.x);
  EXPECT_GT(seen.high_px.x, 0.95 * size_px.x);
  EXPECT_LT(seen.low_px.y, 0.05 * size_px.y);
  EXPECT_GT(seen.high_px.y, 0.95 * size_px.y);
  EXPECT_NEAR(seen.coarsest_px.x, 1, 0.01) << "as dense as the densest view, no denser";
  EXPECT_NEAR(seen.coarsest_px.y, 1, 0.01);
}

TEST(SourceAdvice, standsInTheMiddleOfAllEyes) {
  const SourceAdvice advice = adviceFor(quilt(0.7));
  EXPECT_NEAR(advice.source.camera.pose.position_m.x, 0, 1e-12);
  EXPECT_EQ(advice.source.camera.pose.orientation, Pose{}.orientation);
}

TEST(SourceAdvice, servesCamerasThatAreTurnedAndStandAhead) {
  const AtlasLayout layout = layoutFor(arcOfCameras());
  const SourceAdvice advice = adviceFor(arcOfCameras());
  const Seen seen = expectToServe(advice.source, camerasOf(layout), layout.tile_size_px);
  EXPECT_GT(seen.count, 1000u);
  EXPECT_LE(seen.coarsest_px.x, 1.001) << "nothing is lost";
  EXPECT_LE(seen.coarsest_px.y, 1.001);
  EXPECT_GT(seen.coarsest_px.x, 0.8) << "for little more than it takes";
  EXPECT_GT(seen.coarsest_px.y, 0.8);
}

TEST(SourceAdvice, servesEveryEyeOfALenticularPanel) {
  const DisplaySpec panel{.kind = LenticularSpec{.preset = "portrait", .fov_y_rad = 0.5}};
  const AtlasLayout layout = layoutFor(panel);
  const auto& rays = std::get<LenticularRays>(layout.rays);
  std::vector<Camera> eyes;
  for (const double share : {-1.0, -0.3, 0.0, 1.0}) {
    const double x_m = rays.distance_m * std::tan(share * rays.view_cone_rad / 2);
    eyes.push_back(
        sampledCamera(layout.views[0].camera, {.eye_m = {x_m, 0}}, layout.focal_distance_m));
  }
  const SourceAdvice advice = adviceFor(panel);
  EXPECT_GT(expectToServe(advice.source, eyes, layout.tile_size_px).count, 100u);
  EXPECT_GE(advice.layer_count, 2u);
}

TEST(SourceAdvice, servesEveryLensOfAnIntegralPanel) {
  IntegralSpec integral{.panel_px = {60, 40},
                        .pixel_pitch_m = 0.001,
                        .lens_pitch_m = 0.01,
                        .focal_length_m = 0.01,
                        .scale = 10};
  const SourceAdvice advice = adviceFor({.kind = integral});
  std::vector<Camera> lenses;
  for (const double x_px : {-25.0, 5.0, 25.0}) {
    for (const double y_px : {-15.0, 5.0, 15.0}) {
      lenses.push_back({.pose = {.position_m = {x_px * 0.01, y_px * 0.01, 0}},
                        .intrinsics = {.focal_px = {10, 10}, .principal_px = {5, 5}}});
    }
  }
  EXPECT_GT(expectToServe(advice.source, lenses, {10, 10}).count, 1000u);
}

TEST(SourceAdvice, takesALayerWithoutParallaxAndMoreTheWiderGapsAre) {
  const SourceAdvice single = adviceFor(
      {.kind = QuiltSpec{.columns = 1, .rows = 1, .size_px = {300, 400}, .fov_y_rad = 0.6}});
  EXPECT_EQ(single.layer_count, 1u);
  EXPECT_EQ(single.source.size_px, (SizePx{300, 400})) << "the view itself";
  EXPECT_EQ(adviceFor(quilt(0.05)).layer_count, 2u);
  EXPECT_FALSE(adviceFor(quilt(0.05)).second_source);
  EXPECT_EQ(adviceFor(quilt(0.7)).layer_count, 3u);
}

TEST(SourceAdvice, setsASecondSourceAtTheEndOfTheEyes) {
  const AtlasLayout layout = layoutFor(quilt(0.7));
  const SourceAdvice advice = adviceFor(quilt(0.7));
  ASSERT_TRUE(advice.second_source);
  EXPECT_NEAR(std::abs(advice.second_source->camera.pose.position_m.x),
              layout.views.back().camera.pose.position_m.x, 1e-12);
  const Seen seen = expectToServe(*advice.second_source, camerasOf(layout), layout.tile_size_px);
  EXPECT_GT(seen.count, 1000u);
}

TEST(SourceAdvice, standsInTheWorldWhereTheDisplayDoes) {
  DisplaySpec spec = quilt(0.7);
  const glm::dquat turned = glm::angleAxis(0.3, glm::dvec3(0, 1, 0));
  spec.world_pose = Pose{.position_m = {1, 2, 3}, .orientation = turned};
  const SourceAdvice advice = adviceFor(spec);
  EXPECT_NEAR(glm::distance(advice.source.camera.pose.position_m, glm::dvec3(1, 2, 3)), 0, 1e-12);
  EXPECT_EQ(advice.source.camera.pose.orientation, turned);
}

TEST(SourceAdvice, refusesDepthsAndDisplaysWithoutAFieldOfView) {
  const auto fieldFor = [](const DisplaySpec& spec, double near_m, double far_m) {
    return fieldOf(adviseSource(completed(spec), near_m, far_m).status());
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(fieldFor(quilt(0.7), 0, 1), "near_m");
  EXPECT_EQ(fieldFor(quilt(0.7), nan, 1), "near_m");
  EXPECT_EQ(fieldFor(quilt(0.7), 2, 1), "far_m");
  EXPECT_EQ(fieldFor(quilt(0.7), 1, nan), "far_m");
  EXPECT_EQ(fieldFor(quilt(0.7), 1, std::numeric_limits<double>::infinity()), "far_m");
  EXPECT_EQ(fieldFor({.kind = QuiltSpec{.preset = "portrait"}}, 1, 2), "display.quilt.fov_y_rad");
  EXPECT_EQ(fieldFor({.kind = StereoSpec{.eye_size_px = {10, 10}}}, 1, 2),
            "display.stereo.fov_y_rad");
}

TEST(SourceAdvice, refusesViewsThatNoPinholeSees) {
  const DisplaySpec sideways{.kind = CamerasSpec{.cameras = {{.projection = Fov{.left_rad = 1.4,
                                                                                .right_rad = 1.5,
                                                                                .up_rad = 0.1,
                                                                                .down_rad = -0.1}}},
                                                 .tile_size_px = {10, 10}}};
  const auto advice = adviseSource(completed(sideways), kNear_m, kFar_m);
  EXPECT_EQ(advice.status().code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_EQ(fieldOf(advice.status()), "display");
}

}  // namespace
}  // namespace viewloom::source_advice_test
