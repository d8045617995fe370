// SPDX-License-Identifier: Apache-2.0
// Pictures, layers, motion and what can be known of a view, against closed forms.
#include "support/truth/picture.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "frame/limits.h"
#include "support/truth/known.h"
#include "support/truth/picture_frame.h"
#include "support/truth/scenes.h"

namespace viewloom::truth::picture_test {
namespace {

constexpr SizePx kSize_px{96, 72};

// Off-axis, turned and beside the origin.
Camera anyCamera() {
  return {.pose = {.position_m = {0.2, -0.1, 0.3},
                   .orientation = glm::dquat(glm::dvec3(0.05, -0.1, 0.2))},
          .intrinsics = {{80, 84}, {41, 39.5}}};
}

Camera plainCamera() {
  return {.pose = {}, .intrinsics = {{80, 80}, {48, 36}}};
}

Picture pictureOf(const Scene& scene, const Camera& camera, double time_s = 0) {
  return takePicture(Instant(scene, time_s), camera,
                     {.size_px = kSize_px, .layer_count = 4, .color = ColorOver::kCenter});
}

Body plainBody(const Shape& shape, const glm::dvec3& at_m, const glm::vec3& color) {
  return {.shape = shape, .pose = {.position_m = at_m}, .paint = {color, color}};
}

size_t pixelAt(uint32_t x, uint32_t y) {
  return size_t{y} * kSize_px.width + x;
}

// visit(px, ray through its centre)
template <typename Visit>
void forEachPixel(const Camera& camera, const Visit& visit) {
  for (uint32_t y = 0; y < kSize_px.height; ++y) {
    for (uint32_t x = 0; x < kSize_px.width; ++x) {
      visit(pixelAt(x, y), rayThrough(camera, {x + 0.5, y + 0.5}));
    }
  }
}

TEST(TruthPicture, depthIsPlanarAndLiesOnTheSphere) {
  const glm::dvec3 center_m(0.3, 0.2, -4);
  constexpr double kRadius_m = 1.2;
  Scene scene;
  scene.add(plainBody(Sphere{kRadius_m}, center_m, glm::vec3(0.5F)));
  const Camera camera = anyCamera();
  const Picture picture = pictureOf(scene, camera);
  int seen_count = 0;
  forEachPixel(camera, [&](size_t px, const Ray& ray) {
    const glm::dvec3 forward = camera.pose.orientation * glm::dvec3(0, 0, -1);
    EXPECT_NEAR(glm::dot(ray.direction, forward), 1, 1e-14);
    // The nearer root of |origin + t direction - center| = radius.
    const glm::dvec3 offset = ray.origin_m - center_m;
    const double a = glm::dot(ray.direction, ray.direction);
    const double b = 2 * glm::dot(offset, ray.direction);
    const double c = glm::dot(offset, offset) - kRadius_m * kRadius_m;
    const double root = b * b - 4 * a * c;
    const double depth_m = root < 0 ? 0 : (-b - std::sqrt(root)) / (2 * a);
    EXPECT_NEAR(double{picture.layers[0].depth_m[px]}, depth_m, 1e-6);
    if (root < 0) return;
    ++seen_count;
    const glm::dvec3 normal = (offset + depth_m * ray.direction) / kRadius_m;
    EXPECT_NEAR(glm::distance(glm::dvec3(picture.layers[0].normal[px]), normal), 0, 1e-6);
    EXPECT_EQ(picture.layers[1].depth_m[px], 0);
  });
  EXPECT_GT(seen_count, 500);
}

TEST(TruthPicture, layersAreSortedAndFaceTheCamera) {
  for (const Scene& scene : {clutteredRoom(), thinStructures(), largeSmooth()}) {
    const Camera camera = anyCamera();
    const Instant instant(scene, 0);
    const Picture picture = pictureOf(scene, camera);
    forEachPixel(camera, [&](size_t px, const Ray& ray) {
      const HitColumn column = instant.peel(ray, kLayersMax);
      for (uint32_t layer = 0; layer < kLayersMax; ++layer) {
        const PictureLayer& planes = picture.layers[layer];
        if (layer >= column.count) {
          EXPECT_EQ(planes.depth_m[px], 0);
          EXPECT_EQ(planes.body[px], kNoBody);
          continue;
        }
        EXPECT_EQ(planes.depth_m[px], static_cast<float>(column.hits[layer].depth));
        const double before_m = layer == 0 ? 0 : column.hits[layer - 1].depth;
        EXPECT_LE(before_m, column.hits[layer].depth);
        if (planes.body[px] == kSky) continue;
        EXPECT_NEAR(glm::length(planes.normal[px]), 1, 1e-6F);
        EXPECT_LT(glm::dot(column.hits[layer].normal, ray.direction), 0);
      }
      // Fewer layers are the nearest of them.
      const HitColumn two = instant.peel(ray, 2);
      EXPECT_EQ(two.count, std::min(column.count, 2U));
      for (uint32_t i = 0; i < two.count; ++i) EXPECT_EQ(two.hits[i].body, column.hits[i].body);
    });
  }
}

TEST(TruthPicture, motionIsTheFiniteDifferenceOfWhereTheMaterialIs) {
  constexpr double kTime_s = 0.3;
  constexpr double kStep_s = 1e-4;  // its square times the third derivative: below 1e-7 m/s
  const Scene scene = clutteredRoom();
  const Camera camera = plainCamera();
  const Picture picture = pictureOf(scene, camera, kTime_s);
  int moving_count = 0;
  forEachPixel(camera, [&](size_t px, const Ray& ray) {
    const PictureLayer& planes = picture.layers[0];
    const Body& body = scene.bodies[planes.body[px]];
    const glm::dvec3 point_m = ray.origin_m + double{planes.depth_m[px]} * ray.direction;
    const Pose body_from_world = inverse(body.poseAt(kTime_s));
    const Pose own{.position_m =
                       body_from_world.position_m + body_from_world.orientation * point_m};
    const glm::dvec3 after_m = compose(body.poseAt(kTime_s + kStep_s), own).position_m;
    const glm::dvec3 before_m = compose(body.poseAt(kTime_s - kStep_s), own).position_m;
    const glm::dvec3 motion_mps = (after_m - before_m) / (2 * kStep_s);
    EXPECT_NEAR(glm::distance(glm::dvec3(planes.motion_mps[px]), motion_mps), 0, 1e-6);
    moving_count += glm::length(motion_mps) > 0 ? 1 : 0;
  });
  EXPECT_GT(moving_count, 100);
}

TEST(TruthPicture, lightOfAPixelIsTheShareOfItsArea) {
  // The edge of a black sheet before a white one stands 0.3 px into column 40.
  Scene scene;
  const double edge_m = 2 * (40.3 - 48) / 80;
  scene.add(plainBody(Box{{4, 8, 0}}, {edge_m - 4, 0, -2}, glm::vec3(0.0F)));
  scene.add(plainBody(Box{{20, 20, 0}}, {0, 0, -3}, glm::vec3(1.0F)));
  const Picture picture =
      takePicture(Instant(scene, 0), plainCamera(), {.size_px = kSize_px, .layer_count = 2});
  const float white = picture.layers[0].color[pixelAt(41, 30)].r;
  EXPECT_EQ(picture.layers[0].color[pixelAt(39, 30)].r, 0);
  EXPECT_NEAR(picture.layers[0].color[pixelAt(40, 30)].r, 0.7F * white, 1.0F / 21 * white);
  EXPECT_EQ(picture.layers[0].is_mixed[pixelAt(40, 30)], 1);
  EXPECT_EQ(picture.layers[0].is_mixed[pixelAt(41, 30)], 0);
  // Deeper layers do not mix.
  EXPECT_FLOAT_EQ(picture.layers[1].color[pixelAt(39, 30)].r, white);
  EXPECT_EQ(picture.layers[1].is_mixed[pixelAt(39, 30)], 0);
}

TEST(TruthPicture, aPointLooksTheSameFromEverywhere) {
  const Instant instant(clutteredRoom(), 0);
  const glm::dvec3 other_m(0.4, 0.1, 0.2);
  int compared_count = 0;
  forEachPixel(plainCamera(), [&](size_t, const Ray& ray) {
    const Hit hit = instant.peel(ray, 1).hits.front();
    const Ray other{other_m, ray.origin_m + hit.depth * ray.direction - other_m};
    const HitColumn column = instant.peel(other, kLayersMax);
    const Hit* const again = column.find(hit.body);
    if (again == nullptr || std::abs(again->depth - 1) > 1e-9) return;
    ++compared_count;
    const glm::vec3 difference = instant.color(ray, hit) - instant.color(other, *again);
    EXPECT_LT(glm::length(difference), 1e-5F);
  });
  EXPECT_GT(compared_count, 5000);
}

TEST(TruthKnown, aSourceKnowsAllItSeesItself) {
  const Instant instant(thinStructures(), 0);
  const auto known = knownFrom(instant, anyCamera(), kSize_px, anyCamera(), kSize_px);
  const auto empty = std::count(known.begin(), known.end(), kEmpty);
  EXPECT_EQ(std::count(known.begin(), known.end(), 0) + empty, int(known.size()));
}

TEST(TruthKnown, tellsLayersFacesAndBorders) {
  // A box 1 m deep before a wall, seen from the right of its right face: 2 m to the right.
  Scene scene;
  scene.add(plainBody(Box{{0.5, 0.5, 0.5}}, {0, 0, -3}, glm::vec3(0.5F)));
  scene.add(plainBody(Box{{50, 50, 0}}, {0, 0, -6}, glm::vec3(0.9F)));
  const Camera view{.pose = {.position_m = {2, 0, 0}}, .intrinsics = {{40, 40}, {60, 36}}};
  const auto known = knownFrom(Instant(scene, 0), plainCamera(), kSize_px, view, kSize_px);
  const auto at = [&](const glm::dvec3& point_m) {
    const glm::dvec3 own = (point_m - view.pose.position_m) / -point_m.z;
    return known[pixelAt(uint32_t(60 + 40 * own.x), uint32_t(36 - 40 * own.y))];
  };
  EXPECT_EQ(at({0.3, 0, -2.5}), 0) << "the front";
  EXPECT_EQ(at({0.5, 0, -3}), kFacingAway) << "the right face";
  EXPECT_EQ(at({1.1, 0, -6}), 1) << "the wall behind it";
  EXPECT_EQ(at({2, 0, -6}), 0) << "the wall beside it";
  EXPECT_EQ(at({4, 0, -6}), kOutside) << "the wall beyond the source's border";
}

TEST(TruthFrame, isOneThatTheServerAccepts) {
  const Picture picture = pictureOf(clutteredRoom(), anyCamera());
  const FramePtr frame = frameOf(picture, 3);
  EXPECT_EQ(validateFrame(frame->format, FrameLimits{}), absl::OkStatus());
  ASSERT_EQ(frame->sources[0].size(), 3U);
  std::vector<float> depth_m(kSize_px.area());
  ASSERT_EQ(frame->sources[0][2].depth->size(), depth_m.size() * sizeof(float));
  std::memcpy(depth_m.data(), frame->sources[0][2].depth->data(), depth_m.size() * sizeof(float));
  EXPECT_EQ(depth_m, picture.layers[2].depth_m);
}

}  // namespace
}  // namespace viewloom::truth::picture_test
