// SPDX-License-Identifier: Apache-2.0
// Whether depth tells cameras that look around from those that go with a thing.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <utility>

#include <glm/geometric.hpp>

#include "support/truth/picture_frame.h"
#include "support/truth/scenes.h"
#include "temporal/content_motion.h"

namespace viewloom::content_motion_test {
namespace {

constexpr SizePx kSize_px{96, 72};
const Intrinsics kLens{.focal_px = glm::dvec2(84), .principal_px = {48, 36}};

truth::Picture pictureFrom(const Pose& pose, const truth::Scene& scene, double time_s) {
  return takePicture(truth::Instant(scene, time_s), {.pose = pose, .intrinsics = kLens},
                     {.size_px = kSize_px, .color = truth::ColorOver::kCenter});
}

Frame frameFrom(const Pose& pose, const truth::Scene& scene, double time_s) {
  return *truth::frameOf(pictureFrom(pose, scene, time_s), 1);
}

// A box, and nothing else.
truth::Scene box() {
  truth::Scene scene;
  scene.add({.shape = truth::Box{{0.3, 0.2, 0.25}},
             .pose = {.position_m = {0.1, 0, -2},
                      .orientation = glm::angleAxis(0.5, glm::normalize(glm::dvec3(1, 2, 0)))},
             .paint = {.light = glm::vec3(0.7F), .dark = glm::vec3(0.2F), .wave_m = 0.3},
             .velocity_mps = {0.8, 0.3, -0.2},
             .spin_rad_per_s = {0, 0.7, 0.3}});
  return scene;
}

// Pose of a camera that stands before the box and turns with it.
Pose besideBox(double time_s) {
  const truth::Scene scene = box();
  const truth::Body& body = scene.bodies.front();
  return compose(body.poseAt(time_s), inverse(body.pose));
}

TEST(ContentMotion, standsWhereACameraLooksAround) {
  const Pose later{.position_m = {0.05, 0.02, -0.03},
                   .orientation = glm::angleAxis(0.03, glm::normalize(glm::dvec3(1, 3, 0)))};
  for (const truth::Scene& scene : {truth::clutteredRoom(), truth::largeSmooth(), box()}) {
    EXPECT_EQ(contentMotion(frameFrom({}, scene, 0), frameFrom(later, scene, 0), 0),
              ContentMotion::kStands);
  }
}

// Along a plane both look the same, also where 1/Z differs much between two samples.
TEST(ContentMotion, isUnclearWhereACameraGoesOverTheGround) {
  truth::Scene ground;
  ground.add({.shape = truth::Box{{40, 0.1, 40}},
              .pose = {.position_m = {0, -1.5, 0}},
              .paint = {.light = glm::vec3(0.7F), .dark = glm::vec3(0.2F), .wave_m = 0.3}});
  for (const double pitch_rad : {0.0, 0.2, 0.4}) {
    const Pose before{.orientation = glm::angleAxis(-pitch_rad, glm::dvec3(1, 0, 0))};
    Pose later = before;
    later.position_m.z = -0.3;
    EXPECT_EQ(contentMotion(frameFrom(before, ground, 0), frameFrom(later, ground, 0), 0),
              ContentMotion::kUnclear)
        << pitch_rad;
  }
}

TEST(ContentMotion, isWithTheCameraOfAThing) {
  EXPECT_EQ(
      contentMotion(frameFrom(besideBox(0), box(), 0), frameFrom(besideBox(0.1), box(), 0.1), 0),
      ContentMotion::kWithCamera);
}

TEST(ContentMotion, isThatOfTheSourceAsked) {
  const auto both = [](double time_s) {
    return *truth::frameOf(
        {pictureFrom({.position_m = {0.5 * time_s, 0, 0}}, truth::clutteredRoom(), 0),
         pictureFrom(besideBox(time_s), box(), time_s)},
        1);
  };
  EXPECT_EQ(contentMotion(both(0), both(0.1), 0), ContentMotion::kStands);
  EXPECT_EQ(contentMotion(both(0), both(0.1), 1), ContentMotion::kWithCamera);
}

TEST(ContentMotion, isReadFromDepthInAnyMeaning) {
  const auto asCodes = [](Frame frame) {
    PlaneFormat& plane = frame.format.sources[0].layers[0].depth;
    const SharedBytes depth = frame.sources[0][0].depth;
    std::vector<uint8_t> codes;
    for (size_t px = 0; px < kSize_px.area(); ++px) {
      float depth_m = 0;
      std::memcpy(&depth_m, depth->data() + 4 * px, sizeof depth_m);
      const auto code = uint16_t(std::lround(depth_m * 1000));
      codes.push_back(uint8_t(code));
      codes.push_back(uint8_t(code >> 8));
    }
    plane.encoding = PlaneEncoding::kDepthU16;
    plane.depth = {.meaning = DepthMeaning::kPlanar, .scale = 0.001, .invalid_value = 0};
    frame.sources[0][0].depth = std::make_shared<const std::vector<uint8_t>>(std::move(codes));
    return frame;
  };
  EXPECT_EQ(contentMotion(asCodes(frameFrom(besideBox(0), box(), 0)),
                          asCodes(frameFrom(besideBox(0.1), box(), 0.1)), 0),
            ContentMotion::kWithCamera);
}

TEST(ContentMotion, isUnclearWhereBothLookTheSame) {
  truth::Scene wall;
  wall.add({.shape = truth::Box{{9, 9, 0}}, .pose = {.position_m = {0, 0, -2}}, .paint = {}});
  const Pose aside{.position_m = {0.1, 0.1, 0}};
  EXPECT_EQ(contentMotion(frameFrom({}, wall, 0), frameFrom(aside, wall, 0), 0),
            ContentMotion::kUnclear);
  const Frame still = frameFrom({}, box(), 0);
  EXPECT_EQ(contentMotion(still, still, 0), ContentMotion::kUnclear);
  // Turned away.
  const Pose away{.orientation = glm::angleAxis(3.0, glm::dvec3(0, 1, 0))};
  EXPECT_EQ(contentMotion(still, frameFrom(away, box(), 0), 0), ContentMotion::kUnclear);
}

TEST(ContentMotion, isUnclearWhereFramesDiffer) {
  const Frame box_alone = frameFrom(besideBox(0), box(), 0);
  Frame other = frameFrom(besideBox(0.1), box(), 0.1);
  other.format.sources[0].camera.intrinsics.focal_px *= 2;
  EXPECT_EQ(contentMotion(box_alone, other, 0), ContentMotion::kUnclear);
  other = frameFrom(besideBox(0.1), box(), 0.1);
  other.format.sources[0].layers[0].depth.size_px = {48, 144};
  EXPECT_EQ(contentMotion(box_alone, other, 0), ContentMotion::kUnclear);
}

TEST(MovesByItself, isSoOfSourcesWithAPlaneOfMotion) {
  LayerPlanes moving;
  moving.motion = std::make_shared<const std::vector<uint8_t>>(6);
  Frame frame;
  frame.sources = {{LayerPlanes{}}, {LayerPlanes{}, moving}};
  EXPECT_TRUE(movesByItself(frame));
  EXPECT_FALSE(movesByItself(frame, 0));
  EXPECT_TRUE(movesByItself(frame, 1));
  frame.sources.pop_back();
  EXPECT_FALSE(movesByItself(frame));
}

}  // namespace
}  // namespace viewloom::content_motion_test
