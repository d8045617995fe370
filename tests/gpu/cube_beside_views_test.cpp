// SPDX-License-Identifier: Apache-2.0
// Views between a cube map and a pinhole in a room of exact surfaces, beside the true pictures.
#include <algorithm>
#include <iostream>
#include <string>

#include "frame/cube_map.h"
#include "gpu/true_view.h"
#include "gpu/world_views.h"
#include "shared/fault.h"
#include "support/test_device.h"
#include "support/truth/picture_frame.h"
#include "support/truth/scenes.h"

namespace viewloom::cube_beside_views_test {
namespace {

constexpr uint32_t kSide_px = 384;
constexpr SizePx kSource_px{kSide_px, kSide_px};  // of a face, and of the pinhole
constexpr SizePx kView_px{320, 240};
constexpr double kFocal_px = 192;  // of a face, and of the others, so that all are as fine
constexpr size_t kFine = 3;        // views are traced so many times finer, and averaged
constexpr uint32_t kLayers = 2;
// Loss of a full frame below the sources' first layers. Seen: 0.2 dB.
constexpr double kGapMax_db = 1;
// Gain of a full frame above the better one of the two sources alone. Seen: 0.37 and 0.42 dB. Where
// the farthest hit wins it loses 0.1 dB.
constexpr double kGainMin_db = 0.2;
// Turned, so that an edge of its front face crosses the views.
const Pose kCube{.position_m = {-0.15, 0, 0}, .orientation = glm::dquat(glm::dvec3(0, 0.4, 0))};

Camera cameraAt(const glm::dvec3& eye_m, const glm::dvec3& turn_rad, SizePx size_px) {
  return {.pose = {.position_m = eye_m, .orientation = glm::dquat(turn_rad)},
          .intrinsics = {glm::dvec2(kFocal_px), 0.5 * glm::dvec2(size_px.width, size_px.height)}};
}

const std::vector<Camera> kViews = {cameraAt(glm::dvec3(0.0), glm::dvec3(0.0), kView_px),
                                    cameraAt({0.05, 0.03, -0.1}, {0.02, 0.04, 0.05}, kView_px)};

FramePtr joined(const Frame& one, const Frame& other) {
  auto both = std::make_shared<Frame>(one);
  both->format.sources.push_back(other.format.sources.front());
  both->sources.push_back(other.sources.front());
  return both;
}

// A room with both in it.
class CubeBesideViewsTest : public GpuTest {
 protected:
  CubeBesideViewsTest() {
    std::vector<Camera> cameras;
    for (uint32_t face = 0; face < kCubeFaceCount; ++face) {
      cameras.push_back(cubeFaceCamera(kCube, face, kSide_px));
    }
    cameras.push_back(cameraAt({0.15, 0, 0}, {0, 0.03, 0}, kSource_px));
    std::vector<truth::Picture> pictures;
    for (const Camera& camera : cameras) {
      pictures.push_back(truth::takePicture(
          instant_, camera,
          {.size_px = kSource_px, .layer_count = kLayers, .color = truth::ColorOver::kCenter}));
    }
    pinhole_ = truth::frameOf(pictures.back(), kLayers);
    pictures.pop_back();
    cube_ = truth::cubeFrameOf(pictures, kCube, kLayers);
    for (const Camera& view : kViews) {
      truths_.emplace_back(instant_,
                           ViewOfSource{.source = cameras.front(),
                                        .source_px = kSource_px,
                                        .view = view,
                                        .view_px = kView_px,
                                        .more_sources = {cameras.begin() + 1, cameras.end()}});
    }
  }

  // By view.
  std::vector<TrueScore> scoresOf(OfflineRenderer& renderer, const std::string& name,
                                  const Frame& frame) const {
    const RenderedAtlas atlas = renderInWorld(renderer, frame, kViews, kView_px, kFine);
    std::vector<TrueScore> scores;
    for (uint32_t i = 0; i < kViews.size(); ++i) {
      scores.push_back(truths_[i].score(meanView(atlas, i, kView_px, kFine)));
      std::cout << name << ", view " << i << ", dB covered / full frame / hidden: " << scores.back()
                << "\n";
    }
    return scores;
  }

  const truth::Instant instant_{truth::clutteredRoom(), 0};
  std::vector<TrueView> truths_;
  FramePtr pinhole_;
  FramePtr cube_;
};

TEST_F(CubeBesideViewsTest, bothShowMoreThanEither) {
  const FramePtr both = joined(*pinhole_, *cube_);
  OfflineRenderer& renderer = shared<OfflineRenderer>();
  const std::vector<TrueScore> shown = scoresOf(renderer, "both", *both);
  const std::vector<TrueScore> pinhole = scoresOf(renderer, "pinhole", *pinhole_);
  const std::vector<TrueScore> cube = scoresOf(renderer, "cube map", *cube_);
  const Device faulty_device({.planted_fault = abi::kFaultFarthestHit});
  OfflineRenderer faulty(faulty_device);
  const std::vector<TrueScore> mistaken = scoresOf(faulty, "farthest hit of both", *both);
  for (size_t i = 0; i < kViews.size(); ++i) {
    const double least_db = std::max(pinhole[i].full_db, cube[i].full_db) + kGainMin_db;
    EXPECT_LE(shown[i].gapDb(), kGapMax_db);
    EXPECT_GE(shown[i].full_db, least_db);
    EXPECT_LT(mistaken[i].full_db, least_db) << "a planted mistake is found";
  }
}

}  // namespace
}  // namespace viewloom::cube_beside_views_test
