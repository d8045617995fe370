// SPDX-License-Identifier: Apache-2.0
// The walk on the device against the oracle.
#include <glm/gtc/constants.hpp>

#include "gpu/judge_views.h"
#include "oracle/analytic_scenes.h"
#include "oracle/scene_generator.h"
#include "support/test_device.h"

namespace viewloom::trace_test {
namespace {

// Share of rays whose answer hangs on less than the tolerance; silhouettes are most of a small
// noisy scene.
constexpr double kExcusedShareMax = 0.1;

class TraceTest : public GpuTest {
 protected:
  JudgedViews judge(const oracle::Scene& scene, const std::vector<oracle::OutputView>& views,
                    double tolerance_px, const std::string& where, int stride = 1) {
    const std::unique_ptr<StructureSlot> slot = walk_.build(*frameOf(scene));
    return judgeViews(walk_, *slot, sourceOf(scene, *slot), views, tolerance_px, where, stride);
  }

  WalkUnderTest& walk_ = shared<WalkUnderTest>();
};

TEST_F(TraceTest, agreesWithTheOracleFromAllSides) {
  oracle::Random random(11);
  JudgedViews sum;
  for (uint64_t seed = 0; seed < 112; ++seed) {
    const oracle::Scene scene = oracle::randomScene(seed);
    const auto views = oracle::randomViews(random, oracle::kViewKindCount, 13, 10);
    sum.add(judge(scene, views, oracle::toleranceOfSeed_px(seed),
                  "seed " + std::to_string(seed) + " " + scene.name));
  }
  EXPECT_EQ(sum.verdict.differing, 0u) << sum.summary();
  EXPECT_LE(sum.verdict.excusedShare(), kExcusedShareMax) << sum.summary();
  std::cout << sum.summary() << "\n";
}

TEST_F(TraceTest, agreesWithTheOracleInTheSourcesPlane) {
  oracle::Random random(12);
  JudgedViews sum;
  for (uint64_t seed = 0; seed < 112; ++seed) {
    const oracle::Scene scene = oracle::randomScene(seed);
    const auto views = oracle::randomViews(random, oracle::kInPlaneKindCount, 24, 18);
    sum.add(judge(scene, views, 0.05, "seed " + std::to_string(seed) + " " + scene.name));
  }
  EXPECT_EQ(sum.verdict.differing, 0u) << sum.summary();
  EXPECT_LE(sum.verdict.excusedShare(), kExcusedShareMax) << sum.summary();
}

// Tiles much coarser than the source, and tiles of several runs of px with a rest.
TEST_F(TraceTest, agreesWithTheOracleHoweverManyPixelsAnInvocationTakes) {
  struct Widths {
    int source_px, view_px;
  };
  oracle::Random random(13);
  JudgedViews sum;
  for (const Widths& widths : {Widths{240, 13}, Widths{64, 75}, Widths{100, 33}}) {
    for (const int kind_count : {oracle::kViewKindCount, oracle::kInPlaneKindCount}) {
      for (uint64_t seed = 0; seed < 8; ++seed) {
        const oracle::Scene scene =
            oracle::randomScene(seed, widths.source_px, 19, 1 + int(seed % 4));
        const auto views = oracle::randomViews(random, kind_count, widths.view_px, 6);
        sum.add(judge(scene, views, 0.05, "seed " + std::to_string(seed) + " " + scene.name));
      }
    }
  }
  EXPECT_EQ(sum.verdict.differing, 0u) << sum.summary();
  EXPECT_LE(sum.verdict.excusedShare(), kExcusedShareMax) << sum.summary();
}

TEST_F(TraceTest, fromItsOwnPoseASourceSeesItself) {
  for (uint64_t seed = 0; seed < 56; ++seed) {
    const oracle::Scene scene = oracle::randomScene(seed);
    const std::unique_ptr<StructureSlot> slot = walk_.build(*frameOf(scene));
    const oracle::OracleSource source = sourceOf(scene, *slot);
    const TracedView traced = walk_.trace(*slot, {oracle::ownView(scene)}, 0.25).front();
    expectSeesItself(traced, source, "seed " + std::to_string(seed) + " " + scene.name);
  }
}

TEST_F(TraceTest, raysAlongTheSourcesPlaneEnd) {
  // Wider than a cell in which rays look for their start.
  const oracle::Scene scene = oracle::planeScene({.at_origin = 0.25}, 130, 40);
  oracle::OutputView view = oracle::ownView(scene);
  view.width = 3;
  view.height = 2;
  view.pinhole = {{512, 512}, {2.5, 1}};
  view.position_m.x = 0.01;
  // The last column looks so little to the front that its vanishing point, px, is no integer.
  const double angle_rad = glm::half_pi<double>() - 0x1p-31;
  view.orientation = glm::angleAxis(-angle_rad, glm::dvec3(0, 1, 0));
  // So many views that an invocation takes several px, which look for their start together.
  const std::unique_ptr<StructureSlot> slot = walk_.build(*frameOf(scene));
  const std::vector<oracle::OutputView> views(5, view);
  for (const TracedView& traced : walk_.trace(*slot, views, 0.25)) {
    for (const abi::RayRecord& record : traced.records) {
      EXPECT_EQ(record.ray_class, abi::kClassOutside);
    }
  }
}

TEST_F(TraceTest, aSmoothSceneTakesFewVisits) {
  const oracle::Scene scene = oracle::smoothScene(640, 480, 1);
  std::vector<oracle::OutputView> views;
  for (int index = 0; index < 8; ++index) {
    oracle::OutputView view = oracle::ownView(scene);
    view.width = 160;
    view.height = 120;
    view.pinhole.focal_px *= 0.25;
    view.pinhole.principal_px *= 0.25;
    view.position_m.x = 0.04 * (index - 3.5);
    views.push_back(view);
  }
  const JudgedViews judged = judge(scene, views, 0.25, scene.name, 5);
  EXPECT_EQ(judged.verdict.differing, 0u) << judged.summary();
  EXPECT_LE(double(judged.visits) / double(judged.verdict.rays), 4.0) << judged.summary();
}

}  // namespace
}  // namespace viewloom::trace_test
