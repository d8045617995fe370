// SPDX-License-Identifier: Apache-2.0
// Views between two sources of scenes of exact surfaces, beside the true pictures.
#include <iostream>
#include <string>

#include "gpu/true_view.h"
#include "gpu/world_views.h"
#include "support/test_device.h"
#include "support/truth/picture_frame.h"
#include "support/truth/scenes.h"

namespace viewloom::merged_views_test {
namespace {

constexpr SizePx kSource_px{640, 480};
constexpr SizePx kView_px{480, 360};  // as fine as the sources, and inside what they see
constexpr double kFocal_px = 560;
constexpr size_t kFine = 3;       // views are traced so many times finer, and averaged
constexpr double kApart_m = 0.3;  // of the sources: 120 px between the nearest and infinity
constexpr uint32_t kLayers = 2;
// Loss of a full frame below the sources' first layers.
constexpr double kGapMax_db = 1;

Camera cameraAt(const glm::dvec3& eye_m, const glm::dvec2& principal_px,
                const glm::dvec3& turn_rad = glm::dvec3(0.0)) {
  return {.pose = {.position_m = eye_m, .orientation = glm::dquat(turn_rad)},
          .intrinsics = {glm::dvec2(kFocal_px), principal_px}};
}

class MergedViewsTest : public GpuTest {
 protected:
  void check(const std::string& name, const truth::Scene& scene, double covered_min_db) {
    const truth::Instant instant(scene, 0);
    const Camera left = cameraAt({-kApart_m / 2, 0, 0}, {320, 240}, {0, -0.03, 0});
    const Camera right = cameraAt({kApart_m / 2, 0, 0}, {320, 240}, {0, 0.03, 0});
    const std::vector<Camera> views = {
        cameraAt(glm::dvec3(0.0), {240, 180}),
        cameraAt({0.05, 0.03, -0.1}, {240, 180}, {0.02, 0.04, 0.05})};
    std::vector<truth::Picture> pictures;
    for (const Camera& camera : {left, right}) {
      pictures.push_back(truth::takePicture(
          instant, camera,
          {.size_px = kSource_px, .layer_count = kLayers, .color = truth::ColorOver::kCenter}));
    }
    const RenderedAtlas both = render(truth::frameOf(pictures, kLayers), views);
    const RenderedAtlas one = render(truth::frameOf(pictures[0], kLayers), views);
    for (uint32_t i = 0; i < views.size(); ++i) {
      const TrueView truth(instant, {.source = left,
                                     .source_px = kSource_px,
                                     .view = views[i],
                                     .view_px = kView_px,
                                     .more_sources = {right}});
      const TrueScore score = truth.score(meanView(both, i, kView_px, kFine));
      std::cout << name << ", view " << i << ", dB covered / full frame / hidden: two sources "
                << score << "; one " << truth.score(meanView(one, i, kView_px, kFine)) << "\n";
      EXPECT_LE(score.gapDb(), kGapMax_db);
      EXPECT_GE(score.covered_db, covered_min_db);
    }
  }

 private:
  static RenderedAtlas render(const FramePtr& frame, const std::vector<Camera>& views) {
    return renderInWorld(shared<OfflineRenderer>(), *frame, views, kView_px, kFine);
  }
};

TEST_F(MergedViewsTest, twoSourcesShowAClutteredRoom) {
  check("cluttered room", truth::clutteredRoom(), 40.8);
}

TEST_F(MergedViewsTest, twoSourcesShowThinStructures) {
  check("thin structures", truth::thinStructures(), 36.7);
}

TEST_F(MergedViewsTest, twoSourcesShowLargeSmoothSurfaces) {
  check("large smooth surfaces", truth::largeSmooth(), 46.7);
}

}  // namespace
}  // namespace viewloom::merged_views_test
