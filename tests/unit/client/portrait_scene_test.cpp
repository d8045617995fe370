// SPDX-License-Identifier: Apache-2.0
// The portrait scene: its loop, its motion, and how it fits the display that it is made for.
#include "synthetic/portrait_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>

#include "display/depth_budget.h"
#include "synthetic/synthetic_frame.h"

namespace viewloom::portrait_scene_test {
namespace {

constexpr SizePx kSize_px{150, 200};
// Instants of a loop that share no period with what moves.
const std::vector<double> kTimes_s{0.0, 1.1, 2.9, 4.6, 6.3, 8.2, 9.7, 11.9, 13.4, 17.0};

SyntheticLayer sceneAt(double time_s) {
  return renderSyntheticFrame({.size_px = kSize_px,
                               .layer_count = 1,
                               .time_s = time_s,
                               .camera = {},
                               .setting = synthetic::Setting::kPortrait})[0];
}

TEST(PortraitScene, isTheSameAtTheSameTimeOfEachLoop) {
  for (const double time_s : {0.0, 4.0, 16.0}) {
    const SyntheticLayer layer = sceneAt(time_s);
    const SyntheticLayer next = sceneAt(time_s + synthetic::kPortraitLoop_s);
    EXPECT_EQ(layer.color, next.color);
    EXPECT_EQ(layer.depth_m, next.depth_m);
  }
}

TEST(PortraitScene, movesAndThenStandsUntilItsLoopEnds) {
  EXPECT_NE(sceneAt(5.0).color, sceneAt(5.1).color);
  const SyntheticLayer stood = sceneAt(synthetic::kPortraitMoving_s);
  for (const double time_s : {16.0, 18.5, synthetic::kPortraitLoop_s}) {
    EXPECT_EQ(sceneAt(time_s).color, stood.color);
    EXPECT_EQ(sceneAt(time_s).depth_m, stood.depth_m);
  }
}

// Bodies say their velocity, and keep it: no jump, also not where a loop ends.
TEST(PortraitScene, movesSmoothlyAsItSays) {
  constexpr double kStep_s = 1e-3;
  constexpr double kSpeedError_mps = 2e-4;  // of a central difference over two steps
  constexpr double kJoltMax_mps = 5e-3;     // change of a velocity in one step
  for (double time_s = 0; time_s < synthetic::kPortraitLoop_s + 0.5; time_s += 0.0371) {
    const synthetic::Scene before = synthetic::makePortraitScene(time_s - kStep_s);
    const synthetic::Scene now = synthetic::makePortraitScene(time_s);
    const synthetic::Scene after = synthetic::makePortraitScene(time_s + kStep_s);
    ASSERT_EQ(before.spheres.size(), after.spheres.size());
    for (size_t i = 0; i < now.spheres.size(); ++i) {
      const glm::dvec3 moved_m = after.spheres[i].center_m - before.spheres[i].center_m;
      const glm::dvec3 velocity_mps = now.spheres[i].velocity_mps;
      ASSERT_LT(glm::length(moved_m / (2 * kStep_s) - velocity_mps), kSpeedError_mps)
          << "ball " << i << " at " << time_s << " s";
      ASSERT_LT(glm::length(after.spheres[i].velocity_mps - velocity_mps), kJoltMax_mps)
          << "ball " << i << " at " << time_s << " s";
    }
  }
}

// The rods that hold the balls of the mobile end where the balls are.
TEST(PortraitScene, hangsEveryBallOnARod) {
  for (const double time_s : kTimes_s) {
    const synthetic::Scene scene = synthetic::makePortraitScene(time_s);
    for (size_t ball = 0; ball < 8; ++ball) {
      const auto holds = [&](const synthetic::Rod& rod) {
        return glm::length(rod.end_m - scene.spheres[ball].center_m) < 1e-9;
      };
      EXPECT_TRUE(std::any_of(scene.rods.begin(), scene.rods.end(), holds)) << ball;
    }
  }
}

// Seen from the outermost eyes of a cone of 40 degrees, too: nothing that floats before the window
// is cut by its edge, and nothing is seen that the source does not see.
TEST(PortraitScene, keepsEveryBallInTheWindowOfEveryEye) {
  const double half_height_m = synthetic::kPortraitFocus_m * std::tan(std::numbers::pi / 10);
  const double half_width_m = 0.75 * half_height_m;
  const double eye_m = synthetic::kPortraitFocus_m * std::tan(std::numbers::pi / 9);
  for (const double time_s : kTimes_s) {
    for (const synthetic::Sphere& ball : synthetic::makePortraitScene(time_s).spheres) {
      const double distance_m = -ball.center_m.z;
      const double scale = synthetic::kPortraitFocus_m / distance_m;
      const bool is_behind = scale < 1;
      for (const double x_m : {-eye_m, 0.0, eye_m}) {
        // A ball behind the window may be hidden by its edge.
        if (is_behind && x_m != 0) continue;
        const double side_m = ball.center_m.x + std::copysign(ball.radius_m, ball.center_m.x);
        EXPECT_LT(std::abs(x_m + (side_m - x_m) * scale), half_width_m) << time_s << " s";
        EXPECT_LT((std::abs(ball.center_m.y) + ball.radius_m) * scale, half_height_m);
      }
    }
  }
}

// Every ray that comes through the window ends in the box.
TEST(PortraitScene, hasNoSkyBehindItsWindow) {
  for (const double time_s : kTimes_s) {
    for (const float depth_m : sceneAt(time_s).depth_m) {
      ASSERT_GT(depth_m, 1.9F);
      ASSERT_LT(depth_m, 3.85F);
    }
  }
}

SourceStats statsOf(std::vector<float> depth_m) {
  std::sort(depth_m.begin(), depth_m.end());
  const auto inv_z_at = [&](double share) {
    return 1.0 / double{depth_m[static_cast<size_t>(share * double(depth_m.size() - 1))]};
  };
  return {.inv_z_min = inv_z_at(1),
          .inv_z_max = inv_z_at(0),
          .inv_z_near = inv_z_at(0.02),
          .inv_z_far = inv_z_at(0.98)};
}

DepthSpread spreadOf(std::vector<float> depth_m) {
  std::sort(depth_m.begin(), depth_m.end(), std::greater<>());
  DepthSpread spread;
  for (const float z_m : depth_m) {
    const double inv_z = 1.0 / double{z_m};
    spread.push_back({.inv_z_low = inv_z, .inv_z_high = inv_z + 1e-6, .count = 1});
  }
  return spread;
}

// Two neighbouring views of the preset `portrait` fuse everywhere, and its focal plane, which comes
// from the first frame, is that of the board.
TEST(PortraitScene, staysInTheDepthBudgetOfThePortraitPreset) {
  QuiltSpec portrait{.preset = "portrait"};
  ASSERT_TRUE(takePreset(portrait).ok());
  DisplaySpec open;
  open.kind = portrait;
  const absl::StatusOr<DisplaySpec> spec = completeDisplaySpec(open);
  ASSERT_TRUE(spec.ok()) << spec.status();
  const Intrinsics intrinsics = syntheticCamera(kSize_px).intrinsics;
  const StreamDefaults defaults = streamDefaults(intrinsics, kSize_px, statsOf(sceneAt(0).depth_m));
  EXPECT_NEAR(defaults.focal_distance_m, synthetic::kPortraitFocus_m, 0.05);
  const absl::StatusOr<AtlasLayout> layout = makeAtlasLayout(*spec, defaults);
  ASSERT_TRUE(layout.ok()) << layout.status();
  for (const double time_s : kTimes_s) {
    const std::vector<float> depth_m = sceneAt(time_s).depth_m;
    const auto budget = depthBudget(*layout, statsOf(depth_m), spreadOf(depth_m));
    ASSERT_TRUE(budget.has_value());
    EXPECT_EQ(budget->beyond_fusing_share, 0) << time_s << " s";
    EXPECT_LT(budget->disparity_max_px, kFusingLimit_px) << time_s << " s";
    EXPECT_GT(budget->disparity_max_px, 0.6 * kFusingLimit_px) << "and uses it";
  }
}

}  // namespace
}  // namespace viewloom::portrait_scene_test
