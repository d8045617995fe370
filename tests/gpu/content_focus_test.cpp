// SPDX-License-Identifier: Apache-2.0
// Where displays that leave their focal plane to the stream have it, of sources that are flat.
#include <cmath>
#include <string>

#include "display/atlas_layout.h"
#include "display/depth_budget.h"
#include "gpu/walk_under_test.h"
#include "oracle/analytic_scenes.h"
#include "support/test_device.h"
#include "sweep/sweep_source.h"

namespace viewloom::content_focus_test {
namespace {

// Share of the distance. The device's range is that of its nodes. They keep 14 bits of a plane's
// middle behind the first, and its error, as much again, is rounded up at each of five levels by a
// step of two to an octave: 1, 1.5, 2, 3, 4, 6.
constexpr double kDeviceShare = (1 + 6.0) / (1 << 14);
constexpr double kSweptShare = 1e-6;  // samples of binary32

class ContentFocus : public GpuTest {
 protected:
  static void expectAt(double inv_z, const SourceStats& stats, const DepthSpread& spread,
                       double share_max) {
    EXPECT_NEAR(contentFocalDistance(stats) * inv_z, 1, share_max);
    const auto spec = completeDisplaySpec({.kind = QuiltSpec{.preset = "portrait"}});
    const auto layout = makeAtlasLayout(
        *spec, streamDefaults({.focal_px = {80, 80}, .principal_px = {32, 24}}, {64, 48}, stats));
    ASSERT_TRUE(layout.ok()) << layout.status();
    EXPECT_NEAR(layout->focal_distance_m * inv_z, 1, share_max);
    const auto budget = depthBudget(*layout, stats, spread);
    ASSERT_TRUE(budget);
    EXPECT_NEAR(budget->suggested_focal_distance_m * inv_z, 1, share_max);
  }

  WalkUnderTest& walk_ = shared<WalkUnderTest>();
  WorkerPool workers_{1};
  SweepSource source_;
};

TEST_F(ContentFocus, liesOnAWallSquareToTheView) {
  // Through a bin of the histogram of depths, a 32nd of an octave, and beyond.
  for (const double inv_z : {0.25, 0.2519, 0.2541, 0.2578, 0.26, 0.9999, 1.0, 1.031}) {
    SCOPED_TRACE(std::to_string(inv_z) + " 1/m");
    const FramePtr frame = frameOf(oracle::planeScene({0, 0, inv_z}, 64, 48));
    const std::unique_ptr<StructureSlot> slot = walk_.build(*frame);
    expectAt(inv_z, slot->stats(), slot->depthSpread(), kDeviceShare);
    source_.prepare(frame, workers_);
    expectAt(inv_z, source_.measured().stats, source_.measured().depths, kSweptShare);
  }
}

}  // namespace
}  // namespace viewloom::content_focus_test
