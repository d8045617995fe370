// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <span>

#include <gtest/gtest.h>

#include "calibration/make_lenticular.h"
#include "gpu/buffer.h"
#include "gpu/commands.h"
#include "gpu/compute_pass.h"
#include "gpu/submission.h"
#include "shaders/view_coordinates.h"
#include "support/test_device.h"

namespace viewloom::view_coordinate_test {
namespace {

struct CoordinatesPush {
  uint64_t target = 0;
  uint32_t width_px = 0;
  uint32_t view_count = 0;
  abi::Lenticular lens;
};

constexpr uint32_t kGroupSize = 64;

class ViewCoordinateTest : public GpuTest {
 protected:
  void expectTheBitsOfTheCpu(const Calibration& calibration, uint32_t view_count) {
    const SizePx size_px = calibration.screen_px;
    const auto pixel_count = static_cast<uint32_t>(size_px.area());
    const Buffer target(device(), {.size_bytes = pixel_count * 3 * 2 * sizeof(uint32_t),
                                   .intent = MemoryIntent::kReadback});
    const ComputePass pass(device(), {.spirv = view_coordinates_spirv,
                                      .push_bytes = sizeof(CoordinatesPush),
                                      .debug_name = "view coordinates"});
    const abi::Lenticular lens = makeLenticular(calibration);
    Timeline timeline(device());
    CommandRecorder recorder(device());
    const Commands commands = recorder.begin();
    pass.record(commands, CoordinatesPush{target.address(), size_px.width, view_count, lens},
                (pixel_count + kGroupSize - 1) / kGroupSize);
    recordComputeToHost(commands);
    ASSERT_TRUE(timeline.wait(recorder.submit(timeline)));

    const auto* got = reinterpret_cast<const uint32_t*>(target.mapped().data());
    for (uint32_t pixel = 0; pixel < pixel_count; ++pixel) {
      const uint32_t x = pixel % size_px.width;
      const uint32_t y = pixel / size_px.width;
      for (uint32_t channel = 0; channel < 3; ++channel, got += 2) {
        const float coordinate = abi::viewCoordinate(lens, x, y, channel);
        ASSERT_EQ(got[0], std::bit_cast<uint32_t>(coordinate)) << x << ", " << y << ", " << channel;
        ASSERT_EQ(got[1], abi::nearestView(coordinate, view_count)) << x << ", " << y;
      }
    }
  }
};

TEST_F(ViewCoordinateTest, hasTheSameBitsOnEveryDevice) {
  Calibration calibration{.pitch = 44.75,
                          .slope = -6.87,
                          .center = 0.17,
                          .dpi = 283,
                          .screen_px = {640, 360},
                          .cells = {{{-0.31, 0.25}, {0.28, 0.25}, {0, -0.25}},
                                    {{-0.31, -0.25}, {0.28, -0.25}, {0, 0.25}},
                                    {{0.1, 0.2}, {0.3, 0.4}, {-0.2, -0.1}}}};
  for (uint32_t mode = 0; mode < 5; ++mode) {
    SCOPED_TRACE(mode);
    calibration.cell_pattern_mode = mode;
    expectTheBitsOfTheCpu(calibration, 48);
  }
  calibration.cells.clear();
  calibration.inv_view = false;
  calibration.flip_x = true;
  expectTheBitsOfTheCpu(calibration, 2500);
}

TEST_F(ViewCoordinateTest, hasThemOnTheLargestPanels) {
  expectTheBitsOfTheCpu(
      {.pitch = 80.7, .slope = -6.3, .center = -0.3, .dpi = 280, .screen_px = {16384, 16}}, 66);
}

}  // namespace
}  // namespace viewloom::view_coordinate_test
