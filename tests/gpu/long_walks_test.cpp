// SPDX-License-Identifier: Apache-2.0
// Rays that pass thousands of cells, as a hostile frame makes them, in runs of many px: lavapipe
// ends all loops of an invocation after 65535 rounds of them together, without a word.
#include <algorithm>

#include "gpu/judge_views.h"
#include "support/test_device.h"

namespace viewloom::long_walks_test {
namespace {

constexpr int kHeight_px = 16;
constexpr int kToothRows_px = 4;  // the least side of a node, so that each has a tooth
constexpr float kNear = 1;        // 1/m
constexpr float kFar = 1.0F / 64;
constexpr double kTolerance_px = 0.25;
constexpr int kViewWidth_px = 480;
// The most lanes of a subgroup on a software device, or more: each lane is a view.
constexpr int kViewCount = 8;

// Rows of near teeth, with free rows between them in which nothing but facets tells that a ray
// passes.
oracle::Scene combScene(int width_px) {
  oracle::Scene scene{"comb",
                      oracle::makePlanes(width_px, kHeight_px, 1),
                      {{1.25 * width_px, 1.25 * width_px}, {0.5 * width_px, 0.5 * kHeight_px}},
                      {1e-4F, 0}};
  for (int row = 0; row < kHeight_px; ++row) {
    for (int column = 0; column < width_px; ++column) {
      scene.planes.at(0, column, row) = row % kToothRows_px == 1 ? kNear : kFar;
    }
  }
  return scene;
}

// Beside the source, so that a ray passes `share` of its width, give or take a little.
std::vector<oracle::OutputView> viewsBeside(const oracle::Scene& scene, double share,
                                            const glm::dvec3& moved_m) {
  std::vector<oracle::OutputView> views;
  for (int i = 0; i < kViewCount; ++i) {
    oracle::OutputView view = oracle::ownView(scene);
    const double scale = double(kViewWidth_px) / scene.planes.width;
    view.width = kViewWidth_px;
    view.pinhole.focal_px.x *= scale;
    view.pinhole.principal_px.x *= scale;
    const double eye_m = share * scene.planes.width / scene.pinhole.focal_px.x / kNear;
    view.position_m = glm::dvec3(eye_m * (1 - 0.001 * i), 0, 0) + moved_m;
    view.name = std::to_string(i);
    views.push_back(view);
  }
  return views;
}

class LongWalksTest : public GpuTest {
 protected:
  void expectAllRight(int width_px, double share, const glm::dvec3& moved_m = {}) {
    const oracle::Scene scene = combScene(width_px);
    WalkUnderTest& walk = shared<WalkUnderTest>();
    const auto slot = walk.build(*frameOf(scene));
    const oracle::OracleSource source = sourceOf(scene, *slot);
    const std::vector<oracle::OutputView> views = viewsBeside(scene, share, moved_m);
    const std::vector<TracedView> traced = walk.trace(*slot, views, kTolerance_px);
    for (const TracedView& view : traced) {
      const auto is_traced = [](const abi::RayRecord& record) {
        return record.ray_class - abi::kClassHit < abi::kClassCount - abi::kClassHit;
      };
      ASSERT_TRUE(std::ranges::all_of(view.records, is_traced)) << "px of older bands are left";
    }
    constexpr int kStride = 3;
    const JudgedViews judged =
        judgeTraced(traced, source, views, kTolerance_px, scene.name, kStride);
    EXPECT_EQ(judged.verdict.differing, 0U) << judged.summary();
    // A walk as long as it was meant to be.
    EXPECT_GT(judged.visits_largest, 0.5 * share * width_px);
  }
};

TEST_F(LongWalksTest, areRightBesideTheSource) {
  expectAllRight(2048, 0.9);
}

TEST_F(LongWalksTest, areRightThroughHalfOfTheLargestSource) {
  expectAllRight(8192, 0.5);
}

TEST_F(LongWalksTest, areRightFromBeforeTheSource) {
  expectAllRight(2048, 0.6, {0, 0, -0.01});
}

}  // namespace
}  // namespace viewloom::long_walks_test
