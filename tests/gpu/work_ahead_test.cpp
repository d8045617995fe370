// SPDX-License-Identifier: Apache-2.0
// Kernels of likely displays are compiled while nobody needs the device.
#include <gtest/gtest.h>

#include <chrono>

#include "base/clock.h"
#include "support/test_device.h"
#include "support/test_frames.h"
#include "walk/walk_engine.h"

namespace viewloom::work_ahead_test {
namespace {

constexpr SizePx kSource_px{64, 48};

class WorkAheadTest : public GpuTest {
 protected:
  static uint64_t kernelCount() { return device().kernelCount(); }
};

TEST_F(WorkAheadTest, restsOnceSomebodyHasNeededTheDevice) {
  WalkEngine engine(device(), {.warms_up = true});
  engine.connect(
      {.on_room = [] {},
       .on_failure = [](const std::exception& error) { ADD_FAILURE() << error.what(); }});
  const auto frame = engine.preparer()->make();
  frame->take(test::syntheticFrame(1, kSource_px, 1));
  frame->reserve();
  frame->prepare(SteadyClock(), {});
  const uint64_t before = kernelCount();
  const auto pause = engine.workAhead();
  ASSERT_TRUE(pause.has_value()) << "it has not compiled anything yet";
  EXPECT_GT(pause->count(), 0);
  EXPECT_LE(pause->count(), DeviceUse::kRest_ns);
  EXPECT_EQ(kernelCount(), before) << "a picture of this frame would have waited for that";
  engine.drain();
}

}  // namespace
}  // namespace viewloom::work_ahead_test
