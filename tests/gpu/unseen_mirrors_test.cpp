// SPDX-License-Identifier: Apache-2.0
// Mirrored rays that go behind something whose back nobody knows: the longer they do, the more of
// the environment is in what they show.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <vector>

#include "gpu/seen_mirrors.h"
#include "support/srgb_transfer.h"
#include "support/test_device.h"

namespace viewloom::unseen_mirrors_test {
namespace {

constexpr SizePx kView_px{320, 240};
constexpr double kFocal_px = 240;
constexpr double kFloor_m = -1;
constexpr double kWall_m = 6;            // in front of the eye
constexpr double kCurtain_m = 2;         // so near does it hang
constexpr double kCurtainEnd_m = -0.55;  // its lower end
constexpr float kWallLight = 0.8F;

const Camera kCamera{
    .pose = {},
    .intrinsics = {glm::dvec2(kFocal_px), {0.5 * kView_px.width, 0.5 * kView_px.height}}};

truth::Body evenSheet(const glm::dvec3& half_m, const glm::dvec3& at_m, float light) {
  const glm::vec3 even(light);
  return {.shape = truth::Box{half_m}, .pose = {.position_m = at_m}, .paint = {even, even}};
}

// The curtain hangs from above all that is seen, from side to side: no ray finds where it ends.
truth::Scene floorUnderCurtain() {
  constexpr double kWide_m = 12;
  truth::Scene scene;
  truth::Body& floor = scene.add(evenSheet({kWide_m, 0, kWide_m}, {0, kFloor_m, 0}, 0));
  floor.gloss.light = glm::vec3(1);
  scene.add(evenSheet({kWide_m, kWide_m, 0}, {0, 0, -kWall_m}, kWallLight));
  scene.add(evenSheet({kWide_m, kWide_m, 0}, {0, kCurtainEnd_m + kWide_m, -kCurtain_m}, 0.1F));
  return scene;
}

// exp(-l / Z) of the ray of a px so far below the middle, per focal length: it comes to the floor
// at the depth Z, and goes up behind it as steeply as it came down.
double certaintyBelow(double steepness) {
  const double mirror_m = -kFloor_m / steepness;
  const double end_steepness = -kCurtainEnd_m / kCurtain_m;
  const double passed_m = (-kFloor_m - end_steepness * mirror_m) / (steepness + end_steepness);
  const double unseen_m = (kWall_m - mirror_m - passed_m) * std::hypot(1, steepness);
  return std::exp(-unseen_m / mirror_m);
}

class UnseenMirrors : public GpuTest {
 protected:
  // Linear light of the px of the middle column, from the top.
  std::vector<double> columnOf(const SeenMirrors& seen, uint32_t environment_rgb) {
    const RenderedAtlas atlas =
        renderInWorld(shared<OfflineRenderer>(), *seen.frame, {kCamera}, kView_px, 1,
                      ReflectionSpec{.bounce_count = 1, .environment_rgb = environment_rgb});
    EXPECT_EQ(atlas.reflections.assumed, atlas.reflections.rayCount());
    std::vector<double> column;
    for (uint32_t y = 0; y < kView_px.height; ++y) {
      const size_t px = size_t{y} * kView_px.width + kView_px.width / 2;
      column.push_back(linearFrom(double{atlas.linear[4 * px]}));
    }
    return column;
  }
};

// Difference of the share: seen 0.0008. The curtain ends between two rows of px, as in sources.
constexpr double kApart = 0.003;
constexpr double kLightApart = 0.003;  // seen 0.0007
// Rows whose rays pass under the curtain and then behind it.
constexpr double kMirrorMin_m = 2.2;
constexpr double kMirrorMax_m = 3.5;

// By how much more there is in white surroundings than in the dark.
TEST_F(UnseenMirrors, fadeIntoTheEnvironmentByHowLongRaysWentUnseen) {
  const SeenMirrors seen = seenBy(kCamera, kView_px, floorUnderCurtain(), {.layer_count = 2}, {});
  const std::vector<double> dark = columnOf(seen, 0);
  const std::vector<double> white = columnOf(seen, 0xffffff);
  double apart_max = 0, light_apart_max = 0, certainty_min = 1, certainty_max = 0;
  for (uint32_t y = kView_px.height / 2; y < kView_px.height; ++y) {
    const double steepness = (y + 0.5 - kCamera.intrinsics.principal_px.y) / kFocal_px;
    const double mirror_m = -kFloor_m / steepness;
    if (mirror_m < kMirrorMin_m || mirror_m > kMirrorMax_m) continue;
    SCOPED_TRACE(testing::Message() << "row " << y << ", mirror " << mirror_m << " m away");
    const double wanted = certaintyBelow(steepness);
    const double got = 1 - (white[y] - dark[y]);
    EXPECT_NEAR(got, wanted, kApart);
    const double wall = double{seen.truth[size_t{y} * kView_px.width + kView_px.width / 2].x};
    EXPECT_NEAR(dark[y] / got, wall, kLightApart);
    light_apart_max = std::max(light_apart_max, std::abs(dark[y] / got - wall));
    certainty_min = std::min(certainty_min, wanted);
    certainty_max = std::max(certainty_max, wanted);
    apart_max = std::max(apart_max, std::abs(got - wanted));
  }
  std::cout << "certain by " << certainty_min << " to " << certainty_max << ", apart by up to "
            << apart_max << ", light by up to " << light_apart_max << "\n";
  // Else little is told of how it fades.
  EXPECT_LT(certainty_min, 0.3);
  EXPECT_GT(certainty_max, 0.45);
}

}  // namespace
}  // namespace viewloom::unseen_mirrors_test
