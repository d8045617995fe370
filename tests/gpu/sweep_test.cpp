// SPDX-License-Identifier: Apache-2.0
// The sweep against the oracle. Needs no device.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "gpu/judge_views.h"
#include "gpu/sweep_under_test.h"
#include "oracle/scene_generator.h"

namespace viewloom::sweep_test {
namespace {

// Share of rays whose answer hangs on less than the tolerance; silhouettes are most of a small
// noisy scene.
constexpr double kExcusedShareMax = 0.1;

std::vector<oracle::OutputView> viewsBeside(oracle::Random& random, int count, int width,
                                            int height) {
  std::vector<oracle::OutputView> views;
  for (int i = 0; i < count; ++i) views.push_back(oracle::randomView(random, 0, width, height));
  return views;
}

JudgedViews judge(SweepUnderTest& sweep, const oracle::Scene& scene,
                  const std::vector<oracle::OutputView>& views, double tolerance_px,
                  const std::string& where) {
  sweep.prepare(frameOf(scene));
  const oracle::OracleSource source = sourceOf(scene, sweep.source().measured().stats);
  return judgeTraced(sweep.trace(views, tolerance_px), source, views, tolerance_px, where);
}

JudgedViews judgeSeeds(SweepUnderTest& sweep, uint64_t seed_count) {
  oracle::Random random(11);
  JudgedViews sum;
  for (uint64_t seed = 0; seed < seed_count; ++seed) {
    const oracle::Scene scene = oracle::randomScene(seed);
    const auto views = viewsBeside(random, 3, 24, 18);
    sum.add(judge(sweep, scene, views, oracle::toleranceOfSeed_px(seed),
                  "seed " + std::to_string(seed) + " " + scene.name));
  }
  return sum;
}

TEST(Sweep, agreesWithTheOracle) {
  SweepUnderTest sweep;
  const JudgedViews sum = judgeSeeds(sweep, 400);
  EXPECT_EQ(sum.verdict.differing, 0u) << sum.summary();
  EXPECT_LE(sum.verdict.excusedShare(), kExcusedShareMax) << sum.summary();
  std::cout << sum.summary() << "\n";
}

TEST(Sweep, fromItsOwnPoseASourceSeesItself) {
  SweepUnderTest sweep;
  for (uint64_t seed = 0; seed < 56; ++seed) {
    const oracle::Scene scene = oracle::randomScene(seed);
    sweep.prepare(frameOf(scene));
    const oracle::OracleSource source = sourceOf(scene, SourceStats());
    const TracedView traced = sweep.trace({oracle::ownView(scene)}, 0.25).front();
    expectSeesItself(traced, source, "seed " + std::to_string(seed) + " " + scene.name);
  }
}

// Rough surfaces so close to each other that straight runs of one cross those of the other.
oracle::Scene closeLayers() {
  oracle::Random random(5);
  oracle::Scene scene;
  scene.name = "close layers";
  scene.planes = oracle::makePlanes(60, 4, 2);
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 60; ++column) {
      const float near = float(0.5 + random.uniform(-0.002, 0.002));
      // A pole, behind which rays pass: else no ray gets to the second layer at all.
      const bool is_pole = column == 10;
      scene.planes.at(0, column, row) = is_pole ? 1.0F : near;
      scene.planes.at(1, column, row) = is_pole ? near : near - 0.0005F;
    }
  }
  scene.pinhole = {{60, 60}, {30, 2}};
  scene.kappa = {.absolute = 0.02F, .relative = 0};
  return scene;
}

size_t countOfDeeperHits(SweepUnderTest& sweep) {
  oracle::OutputView view = oracle::ownView(closeLayers());
  view.position_m.x = 0.5;
  sweep.prepare(frameOf(closeLayers()));
  const TracedView traced = sweep.trace({view}, 0.25).front();
  return size_t(std::count_if(traced.records.begin(), traced.records.end(), [](const auto& record) {
    return record.ray_class == abi::kClassHit && record.layer != 0;
  }));
}

TEST(Sweep, showsTheNearerOfLayersCloserThanTheTolerance) {
  SweepUnderTest sweep;
  EXPECT_EQ(countOfDeeperHits(sweep), 0u);
  sweep.plantFault(SweepFault::kPassedIgnored);
  EXPECT_GT(countOfDeeperHits(sweep), 0u);
}

// Walls whose plane contains the eye, but for roundings: of what rays meet on them all digits but
// the first few may be lost.
TEST(Sweep, staysOnSurfacesThatRaysGraze) {
  constexpr uint32_t kWidth = 64;
  constexpr uint32_t kViewWidth = 16000;
  oracle::Random random(3);
  SurfaceRowBuilder builder;
  SweptRow swept;
  uint64_t hit_count = 0;
  for (int wall = 0; wall < 100; ++wall) {
    const double eye_px_m = random.uniform(10, 200);
    const double slope = 1 / eye_px_m * (1 + random.uniform(-1e-6, 1e-6));
    const double inv_z_at_0 = random.uniform(0, 1);
    oracle::Scene scene;
    scene.planes = oracle::makePlanes(kWidth, 1, 1);
    for (uint32_t x = 0; x < kWidth; ++x) {
      scene.planes.at(0, int(x), 0) = float(slope * (x + 0.5) + inv_z_at_0);
    }
    SweepUnderTest sweep;
    sweep.prepare(frameOf(scene));
    RowSource source = sweep.source().rowSource();
    source.steps.kappa = {.least = 0, .share = 0.02F};
    const SurfaceRow& row = builder.build(source, 0.5, float(0.1 / eye_px_m), float(eye_px_m));
    swept.reserve(kViewWidth, row.pieceCountMax());
    float eye = float(eye_px_m);
    for (int nudge = 0; nudge < 10; ++nudge) eye = std::nextafter(eye, 0.0F);
    for (int nudge = -10; nudge < 10; ++nudge, eye = std::nextafter(eye, 1e9F)) {
      const double px = std::floor(random.uniform(0, kViewWidth));
      const float start_px = float(-double{eye} * inv_z_at_0 - px);
      Coverage coverage;
      paintRow(row, {.start_px = start_px, .step_px = 1, .eye_px_m = eye}, {.inv_z_max = 100},
               kViewWidth, swept, coverage);
      for (uint32_t p = 0; p < kViewWidth; ++p) {
        if (swept.inv_z[p] < 0) continue;
        ++hit_count;
        ASSERT_GE(swept.texel[p], 0) << "wall " << wall << ", nudge " << nudge;
        ASSERT_LT(uint32_t(swept.texel[p] / kSubtexelSteps + 1), row.texel_count);
        ASSERT_LE(double{swept.inv_z[p]}, slope * (kWidth + 1) + inv_z_at_0);
      }
    }
  }
  EXPECT_GT(hit_count, 100u);
}

struct PlantedFault {
  SweepFault fault;
  const char* name;
};

class SweepFaultTest : public testing::TestWithParam<PlantedFault> {};

TEST_P(SweepFaultTest, isFound) {
  SweepUnderTest sweep;
  sweep.plantFault(GetParam().fault);
  EXPECT_GT(judgeSeeds(sweep, 400).verdict.differing, 0u);
}

INSTANTIATE_TEST_SUITE_P(
    Each, SweepFaultTest,
    testing::Values(PlantedFault{SweepFault::kRowOff, "rowOff"},
                    PlantedFault{SweepFault::kRunsOff, "runsOff"},
                    PlantedFault{SweepFault::kCrossLinks, "crossLinks"},
                    PlantedFault{SweepFault::kBridges, "bridges"},
                    PlantedFault{SweepFault::kTolerance, "tolerance"},
                    PlantedFault{SweepFault::kFallsBelowSky, "fallsBelowSky"},
                    PlantedFault{SweepFault::kGoesOnBehind, "goesOnBehind"},
                    PlantedFault{SweepFault::kEntryInFront, "entryInFront"},
                    PlantedFault{SweepFault::kLayerDropped, "layerDropped"},
                    PlantedFault{SweepFault::kLastWins, "lastWins"},
                    PlantedFault{SweepFault::kFarSideEnds, "farSideEnds"},
                    PlantedFault{SweepFault::kFarSideEndless, "farSideEndless"}),
    [](const testing::TestParamInfo<PlantedFault>& fault) { return fault.param.name; });

}  // namespace
}  // namespace viewloom::sweep_test
