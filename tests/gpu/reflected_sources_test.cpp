// SPDX-License-Identifier: Apache-2.0
// Reflections of several sources that hold the same, beside those of one of them, which other
// kernels trace, in one piece.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <vector>

#include "gpu/walk_under_test.h"
#include "gpu/world_views.h"
#include "support/test_device.h"
#include "support/truth/mirror_scenes.h"
#include "support/truth/picture_frame.h"
#include "trace/reflection_settings.h"

namespace viewloom::reflected_sources_test {
namespace {

constexpr SizePx kSource_px{160, 120};
constexpr SizePx kView_px{128, 96};
constexpr double kFocal_px = 120;
constexpr uint32_t kLayers = 2;
// Both round where a ray starts otherwise, so that a few rays at silhouettes see the other side.
constexpr int kSameCodes = 2;
constexpr double kOthersMax = 0.001;  // of the px
constexpr double kSharesApart = 0.001;

using ReflectedSourcesTest = GpuTest;

Camera cameraAt(const glm::dvec3& eye_m, SizePx size_px) {
  return {.pose = {.position_m = eye_m},
          .intrinsics = {glm::dvec2(kFocal_px), 0.5 * glm::dvec2(size_px.width, size_px.height)}};
}

double otherShare(const RenderedAtlas& a, const RenderedAtlas& b) {
  size_t others = 0;
  for (size_t i = 0; i < a.color.size(); ++i) {
    int apart = 0;
    for (int shift = 0; shift < 24; shift += 8) {
      const int code_a = int(a.color[i] >> shift & 255), code_b = int(b.color[i] >> shift & 255);
      apart = std::max(apart, std::abs(code_a - code_b));
    }
    others += apart > kSameCodes;
  }
  return double(others) / double(a.color.size());
}

TEST_F(ReflectedSourcesTest, aSourceThatComesTwiceMirrorsAsOne) {
  for (const double roughness : {0.0, 0.4}) {
    const truth::Instant instant(truth::mirrorFloor(roughness), 0);
    const FramePtr one = truth::frameOf(
        truth::takePicture(
            instant, cameraAt(glm::dvec3(0.0), kSource_px),
            {.size_px = kSource_px, .layer_count = kLayers, .color = truth::ColorOver::kCenter}),
        kLayers);
    // From the source's place, so that no silhouette is blended.
    const auto render = [&](const Frame& frame) {
      return renderInWorld(shared<OfflineRenderer>(), frame, {cameraAt(glm::dvec3(0.0), kView_px)},
                           kView_px, 1, ReflectionSpec{.bounce_count = 2, .is_unfiltered = true});
    };
    const RenderedAtlas of_one = render(*one);
    const RenderedAtlas of_both = render(*twice(*one));
    const double share = otherShare(of_one, of_both);
    const auto hits = [](const RenderedAtlas& atlas) {
      return double(atlas.reflections.hit) / double(atlas.reflections.rayCount());
    };
    std::cout << "roughness " << roughness << ": other px " << share << ", hits " << hits(of_one)
              << " and " << hits(of_both) << "\n";
    EXPECT_LE(share, kOthersMax);
    EXPECT_NEAR(hits(of_both), hits(of_one), kSharesApart);
  }
}

// A source that goes with a thing is somewhere else by then than where its frame was uploaded from.
TEST_F(ReflectedSourcesTest, raysAreTurnedToWhereTheJobHasTheSource) {
  const truth::Instant instant(truth::mirrorFloor(0), 0);
  const FramePtr one = truth::frameOf(
      truth::takePicture(instant, cameraAt(glm::dvec3(0.0), kSource_px), {.size_px = kSource_px}),
      1);
  const auto slot = shared<WalkUnderTest>().build(*one);
  std::vector<SeenSource> sources(2, seenSource(one->format.sources.front()));
  sources[1].camera.pose.position_m = {1, 0.5, 0.25};
  const Camera view = cameraAt(glm::dvec3(0.0), kView_px);
  const DisplaySpec spec =
      completeDisplaySpec(
          {.kind = CamerasSpec{.cameras = {{view.pose, view.intrinsics}}, .tile_size_px = kView_px},
           .reflection = ReflectionSpec{.bounce_count = 1}})
          .value();
  const TraceJob job =
      makeTraceJob(std::make_shared<const AtlasLayout>(makeAtlasLayout(spec, {}).value()), spec,
                   Pose{}, sources);
  const abi::ReflectionSettings settings = reflectionSettings(*slot, job, 1, 0);
  // x to the right, y down, z along the axis.
  EXPECT_EQ(settings.first_place.x, -1.0F);
  EXPECT_EQ(settings.first_place.y, 0.5F);
  EXPECT_EQ(settings.first_place.z, 0.25F);
}

// Many rays of rough px are found some rows at a time: the wider the atlas, the fewer.
TEST_F(ReflectedSourcesTest, pxDoNotDependOnHowManyRowsAreReflectedAtATime) {
  const truth::Instant instant(truth::mirrorFloor(0.4), 0);
  const FramePtr one =
      truth::frameOf(truth::takePicture(instant, cameraAt(glm::dvec3(0.0), kSource_px),
                                        {.size_px = kSource_px, .layer_count = kLayers}),
                     kLayers);
  const Camera camera = cameraAt(glm::dvec3(0.0), kView_px);
  for (const FramePtr& frame : {one, twice(*one)}) {
    const auto render = [&](uint32_t count) {
      return renderInWorld(shared<OfflineRenderer>(), *frame, std::vector<Camera>(count, camera),
                           kView_px, 1, ReflectionSpec{.bounce_count = 4, .sample_count = 32});
    };
    constexpr uint32_t kCount = 4;
    const RenderedAtlas narrow = render(1);
    const RenderedAtlas wide = render(kCount);
    size_t others = 0;
    for (size_t px = 0; px < wide.color.size(); ++px) {
      const size_t column = px % (kCount * kView_px.width) % kView_px.width;
      const size_t row = px / (kCount * kView_px.width);
      others += wide.color[px] != narrow.color[row * kView_px.width + column];
    }
    EXPECT_EQ(others, 0U);
  }
}

}  // namespace
}  // namespace viewloom::reflected_sources_test
