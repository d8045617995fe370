// SPDX-License-Identifier: Apache-2.0
// Semitransparent layers: what a ray collects, against the oracle's list of surfaces from front to
// back.
#include <algorithm>
#include <cmath>
#include <random>

#include "gpu/walk_under_test.h"
#include "oracle/analytic_scenes.h"
#include "support/srgb_transfer.h"
#include "support/test_device.h"

namespace viewloom::alpha_test {
namespace {

// sRGB-encoded; half floats, interpolation and the transfer curve: a fifth of an 8-bit step.
constexpr float kColorTolerance = 0.2f / 255;
constexpr double kTransmittanceMin = 1.0 / 255;
constexpr double kTolerance_px = 0.05;

// Adds up the surfaces along a ray; false when something would still be seen behind them.
bool compose(const oracle::OracleAnswer& answer, const std::vector<LinearColor>& layer_colors,
             LinearColor& srgb) {
  std::array<double, 3> light{};
  double transmittance = 1;
  for (const oracle::OracleHit& hit : answer.hits) {
    const LinearColor& color = layer_colors[size_t(hit.facet.layer)];
    for (size_t i = 0; i < 3; ++i) light[i] += transmittance * double{color[i]};
    transmittance *= 1 - double{color[3]};
    if (transmittance <= kTransmittanceMin) break;
  }
  for (size_t i = 0; i < 3; ++i) srgb[i] = float(srgbFrom(light[i]));
  return transmittance <= kTransmittanceMin;
}

class AlphaTest : public GpuTest {
 protected:
  // The share of rays whose colour is the oracle's, of those that end on something opaque.
  double agreeingShare(const oracle::Scene& scene, const std::vector<LinearColor>& layer_colors,
                       const oracle::OutputView& view) {
    const std::unique_ptr<StructureSlot> slot = walk_.build(*frameOf(scene, layer_colors));
    const oracle::OracleSource source = sourceOf(scene, *slot);
    const TracedView traced = walk_.trace(*slot, {view}, kTolerance_px).front();
    int compared_count = 0, agreeing_count = 0;
    for (int row = 0; row < view.height; ++row) {
      for (int column = 0; column < view.width; ++column) {
        const oracle::Ray ray = oracle::rayOf(view, column + 0.5, row + 0.5).ray;
        LinearColor expected{};
        if (!compose(oracle::traceOracle(source, ray, 16), layer_colors, expected)) continue;
        ++compared_count;
        const LinearColor& color = traced.srgb[traced.index(column, row)];
        bool agrees = true;
        for (size_t i = 0; i < 3; ++i) {
          agrees = agrees && std::abs(color[i] - expected[i]) <= kColorTolerance;
        }
        agreeing_count += agrees;
      }
    }
    EXPECT_GT(compared_count, 500);
    return double(agreeing_count) / std::max(compared_count, 1);
  }

  WalkUnderTest& walk_ = shared<WalkUnderTest>();
};

const std::vector<LinearColor> kGlassBeforeWall = {{0.3f, 0.0f, 0.1f, 0.5f}, {0.1f, 0.8f, 0.2f, 1}};

TEST_F(AlphaTest, glassBeforeAWallAddsUp) {
  const oracle::Scene scene =
      oracle::stepScene({0, 0, 1.0}, {1.0 / 4096, 0, 0.25}, 0, true, 64, 48);
  EXPECT_EQ(agreeingShare(scene, kGlassBeforeWall, oracle::ownView(scene)), 1.0);
}

TEST_F(AlphaTest, fromBesideEachSurfaceCountsOnce) {
  const oracle::Scene scene =
      oracle::stepScene({0, 0, 1.0}, {1.0 / 4096, 0, 0.25}, 0, true, 64, 48);
  oracle::OutputView view = oracle::ownView(scene);
  view.position_m = {0.1, 0.05, 0.02};
  EXPECT_EQ(agreeingShare(scene, kGlassBeforeWall, view), 1.0);
}

TEST_F(AlphaTest, fourCurvedLayersAddUpExceptAtSilhouettes) {
  const std::vector<LinearColor> colors = {
      {0.2f, 0, 0, 0.3f}, {0, 0.2f, 0, 0.4f}, {0, 0, 0.3f, 0.5f}, {0.5f, 0.5f, 0.1f, 1}};
  const oracle::Scene scene = oracle::smoothScene(80, 60, 4);
  oracle::OutputView view = oracle::ownView(scene);
  view.position_m = {-0.08, 0.03, 0};
  EXPECT_GE(agreeingShare(scene, colors, view), 0.99);
}

// One layer of which single samples stand out, by less than what is connected: rays from beside
// meet them and, behind them, the samples around.
TEST_F(AlphaTest, aRoughSurfaceCountsOnce) {
  constexpr float kStandsOut = 0.06f;  // 1/m
  constexpr double kConnected = 0.1;
  oracle::Scene scene = oracle::planeScene({0, 0, 0.5}, 64, 48);
  std::mt19937 random(1);
  for (int row = 0; row < 48; ++row) {
    for (int column = 0; column < 64; ++column) {
      if (random() % 8 == 0) scene.planes.at(0, column, row) += kStandsOut;
    }
  }
  const LinearColor glass = {0.3f, 0.0f, 0.1f, 0.5f};
  Frame frame = *frameOf(scene, {glass});
  frame.format.sources[0].connection_tolerance = kConnected;
  oracle::OutputView view = oracle::ownView(scene);
  view.position_m = {0.6, 0, 0};
  const TracedView traced = walk_.trace(*walk_.build(frame), {view}, kTolerance_px).front();
  int hit_count = 0;
  for (size_t px = 0; px < traced.srgb.size(); ++px) {
    if (traced.records[px].ray_class > abi::kClassHitAssumed) continue;
    for (size_t i = 0; i < 3; ++i) {
      ASSERT_NEAR(traced.srgb[px][i], srgbFrom(glass[i]), kColorTolerance) << "px " << px;
    }
    ++hit_count;
  }
  EXPECT_GT(hit_count, 500);
}

}  // namespace
}  // namespace viewloom::alpha_test
