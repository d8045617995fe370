// SPDX-License-Identifier: Apache-2.0
// Exact flat things, one before the other: their distance is no step of depth.
#include <cmath>

#include "gpu/walk_under_test.h"
#include "oracle/analytic_scenes.h"
#include "support/test_device.h"
#include "sweep/sweep_source.h"

namespace viewloom::flat_things_test {
namespace {

class FlatThings : public GpuTest {
 protected:
  WalkUnderTest& walk_ = shared<WalkUnderTest>();
  WorkerPool workers_{1};
  SweepSource source_;
};

TEST_F(FlatThings, areNotJoinedByWhatLiesBetweenThem) {
  const oracle::ImagePlane board{0, 0, 1};
  const oracle::ImagePlane wall{0, 0, 0.25};
  oracle::Scene scene = oracle::stepScene(board, wall, 40, false, 64, 48);
  scene.kappa = {};  // it is measured
  const FramePtr frame = frameOf(scene);
  const std::unique_ptr<StructureSlot> slot = walk_.build(*frame);
  source_.prepare(frame, workers_);
  for (const SourceStats& stats : {slot->stats(), source_.measured().stats}) {
    EXPECT_EQ(stats.depth_step, 0);
    EXPECT_LT(stats.connection_tolerance, 0.01 * (board.at_origin - wall.at_origin));
  }
}

// A level surface goes on as a slope: the bend between them is the same everywhere, as a step is.
TEST_F(FlatThings, doNotStepWhereTheyMeetInACrease) {
  constexpr int kCreaseRow = 98;  // one that is looked at
  constexpr double kSlope = 0.005;
  oracle::Scene scene = oracle::planeScene({0, 0, 0.5}, 256, 192);
  scene.kappa = {};
  for (int row = kCreaseRow; row < 192; ++row) {
    const float inv_z = float(0.5 + kSlope * (row - kCreaseRow));
    for (int column = 0; column < 256; ++column) scene.planes.at(0, column, row) = inv_z;
  }
  const FramePtr frame = frameOf(scene);
  const std::unique_ptr<StructureSlot> slot = walk_.build(*frame);
  source_.prepare(frame, workers_);
  EXPECT_EQ(slot->stats().depth_step, 0);
  EXPECT_EQ(source_.measured().stats.depth_step, 0);
}

TEST_F(FlatThings, joinWhereDepthIsRounded) {
  constexpr double kStep = 1.0 / 256;
  oracle::Scene scene = oracle::planeScene({kStep / 3, 0, 0.5}, 64, 48);
  scene.kappa = {};
  for (int column = 0; column < 64; ++column) {
    const float inv_z = float(std::round(scene.planes.at(0, column, 0) / kStep) * kStep);
    for (int row = 0; row < 48; ++row) scene.planes.at(0, column, row) = inv_z;
  }
  const FramePtr frame = frameOf(scene);
  const std::unique_ptr<StructureSlot> slot = walk_.build(*frame);
  EXPECT_GT(slot->stats().connection_tolerance, kStep);
}

}  // namespace
}  // namespace viewloom::flat_things_test
