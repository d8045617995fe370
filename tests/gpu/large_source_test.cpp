// SPDX-License-Identifier: Apache-2.0
// The largest source there may be: planes and levels beyond what one storage buffer binding could
// reach.
#include <cmath>

#include "gpu/device_error.h"
#include "gpu/walk_under_test.h"
#include "oracle/analytic_scenes.h"
#include "support/test_device.h"

namespace viewloom::large_source_test {
namespace {

constexpr int kSide_px = 8192;
// Positions up to 8192 px in binary32, 16 ulp.
constexpr double kPosition_px = 16.0 * kSide_px / (1 << 23);

// Slopes and samples exact in binary32 over the whole image.
constexpr oracle::ImagePlane kPlane{1.0 / (1 << 16), 1.0 / (1 << 17), 0.25};

class LargeSourceTest : public GpuTest {};

TEST_F(LargeSourceTest, raysMeetAPlaneOf8192By8192Px) {
  const oracle::Scene scene = oracle::planeScene(kPlane, kSide_px, kSide_px);
  WalkUnderTest walk(device());
  std::unique_ptr<StructureSlot> slot;
  try {
    slot = walk.build(*frameOf(scene));
  } catch (const std::exception& error) {
    if (!isOutOfDeviceMemory(error)) throw;
    GTEST_SKIP() << "the device cannot hold a source of 8192x8192 px";
  }

  // 32 x 32 px over the whole image: every corner of it is met.
  oracle::OutputView view = oracle::ownView(scene);
  view.width = view.height = 32;
  view.pinhole.focal_px /= kSide_px / 32.0;
  view.pinhole.principal_px /= kSide_px / 32.0;
  view.position_m = {0.02, 0.01, 0};
  const TracedView traced = walk.trace(*slot, {view}, 0.001).front();
  int met_count = 0;
  for (int row = 0; row < view.height; ++row) {
    for (int column = 0; column < view.width; ++column) {
      const oracle::Ray ray = oracle::rayOf(view, column + 0.5, row + 0.5).ray;
      const glm::dvec3 expected = oracle::imageOf(scene.pinhole, *meet(kPlane, scene.pinhole, ray));
      const abi::RayRecord& record = traced.records[traced.index(column, row)];
      if (expected.x < 0 || expected.x > kSide_px || expected.y < 0 || expected.y > kSide_px) {
        EXPECT_EQ(record.ray_class, abi::kClassOutside);
        continue;
      }
      ASSERT_EQ(record.ray_class, abi::kClassHit) << column << " " << row;
      EXPECT_NEAR(record.x_px, expected.x, kPosition_px);
      EXPECT_NEAR(record.y_px, expected.y, kPosition_px);
      ++met_count;
    }
  }
  EXPECT_GT(met_count, 900);
}

}  // namespace
}  // namespace viewloom::large_source_test
