// SPDX-License-Identifier: Apache-2.0
// Views do not depend on where infinity lies. A constant added to every 1/Z moves each view by a
// constant, so a principal point that moves back gives the same picture.
#include <cmath>
#include <functional>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "gpu/true_view.h"
#include "support/test_device.h"
#include "support/truth/picture_frame.h"
#include "support/truth/scenes.h"
#include "walk/offline_renderer.h"

namespace viewloom::shifted_views_test {
namespace {

constexpr SizePx kSource_px{320, 240};
constexpr SizePx kView_px{200, 150};
constexpr double kFocal_px = 280;
constexpr double kChange_max_db = 0.1;

template <typename Value>
Value valueOrThrow(absl::StatusOr<Value> value) {
  if (!value.ok()) throw std::runtime_error(std::string(value.status().message()));
  return *std::move(value);
}

struct TestScene {
  std::string name;
  std::function<truth::Scene()> make;
  double nearest_m = 0;
  double focal_distance_m = 0;
};

struct Kind {
  std::string name;
  glm::dvec2 moved_px;  // between the nearest surface and infinity
  uint32_t layer_count = 1;
};

Camera sourceCamera() {
  return {.pose = {}, .intrinsics = {glm::dvec2(kFocal_px), {160, 120}}};
}

// Parallel to the source; what lies in focus stays where it is.
Camera cameraAt(const glm::dvec2& eye_m, double inv_z_in_focus) {
  const glm::dvec2 shift_px = kFocal_px * inv_z_in_focus * glm::dvec2(eye_m.x, -eye_m.y);
  return {.pose = {.position_m = {eye_m, 0}},
          .intrinsics = {glm::dvec2(kFocal_px), glm::dvec2(100, 75) + shift_px}};
}

// Infinity comes to 1 / `inv_z`.
truth::Picture shifted(truth::Picture picture, float inv_z) {
  for (truth::PictureLayer& layer : picture.layers) {
    for (float& depth_m : layer.depth_m) {
      if (depth_m > 0) depth_m = 1 / (1 / depth_m + inv_z);
    }
  }
  return picture;
}

class ShiftedViewsTest : public GpuTest {
 protected:
  void expectTheSame(const TestScene& scene, const Kind& kind) {
    const truth::Scene made = scene.make();
    const truth::Instant instant(made, 0);
    const glm::dvec2 eye_m = scene.nearest_m / kFocal_px * kind.moved_px;
    const double inv_focus = 1 / scene.focal_distance_m;
    const TrueView truth(instant,
                         {sourceCamera(), kSource_px, cameraAt(eye_m, inv_focus), kView_px});
    const truth::Picture picture = truth::takePicture(
        instant, sourceCamera(), {.size_px = kSource_px, .layer_count = kind.layer_count});
    std::cout << scene.name << ", " << kind.name << ", " << kind.layer_count << " layers, dB:";
    double plain_db = 0;
    for (const double share : {0.0, 0.5, 10.0}) {
      const double inv_z = share / scene.nearest_m;
      OfflineRenderer& renderer = shared<OfflineRenderer>();
      renderer.build(*truth::frameOf(shifted(picture, float(inv_z)), kind.layer_count));
      const double score_db =
          truth.score(viewFrom(renderer, cameraAt(eye_m, inv_focus + inv_z))).full_db;
      std::cout << " " << score_db;
      if (share == 0) plain_db = score_db;
      EXPECT_NEAR(score_db, plain_db, kChange_max_db)
          << scene.name << ", " << kind.name << ", 1/Z + " << inv_z;
    }
    std::cout << "\n";
  }

 private:
  static ScoredImage viewFrom(OfflineRenderer& renderer, const Camera& camera) {
    DisplaySpec spec;
    spec.kind = CamerasSpec{
        .cameras = {{camera.pose, camera.intrinsics}}, .tile_size_px = kView_px, .columns = 1};
    const RenderedAtlas atlas = valueOrThrow(renderer.render(
        valueOrThrow(completeDisplaySpec(spec)), {.linear = true}, [](uint32_t, uint32_t) {}));
    return meanView(atlas, 0, kView_px, 1);
  }
};

const std::vector<TestScene> kScenes = {{"cluttered room", truth::clutteredRoom, 1.4, 2.5},
                                        {"thin structures", truth::thinStructures, 1.5, 2.5},
                                        {"large smooth", truth::largeSmooth, 3, 8}};

TEST_F(ShiftedViewsTest, sweptScoreTheSameWhereverInfinityLies) {
  for (const TestScene& scene : kScenes) {
    expectTheSame(scene, {"to the right", {12, 0}, 1});
    expectTheSame(scene, {"to the left", {-12, 0}, 2});
  }
}

TEST_F(ShiftedViewsTest, walkedScoreTheSameWhereverInfinityLies) {
  for (const TestScene& scene : kScenes) {
    expectTheSame(scene, {"to the left and down", {-9, -9}, 2});
  }
}

}  // namespace
}  // namespace viewloom::shifted_views_test
