// SPDX-License-Identifier: Apache-2.0
// Opaque 8-bit colour between samples, against means taken in linear light in double precision.
#include <algorithm>
#include <cmath>
#include <random>

#include "gpu/test_device.h"
#include "gpu/walk_under_test.h"
#include "oracle/analytic_scenes.h"
#include "support/srgb_transfer.h"

namespace viewloom {
namespace {

constexpr int kWidth = 256;
constexpr int kHeight = 64;
constexpr double kInvZ = 0.25;
constexpr double kTolerance_px = 0.05;
// shaders/lib/srgb.glsl states both: of a code that is not blended, and of a blend of any two. In
// codes; the first leaves room for rounding to the nearest.
constexpr double kCodeTolerance = 0.25;
constexpr double kBlendTolerance = 2.0;

class ColorBlendTest : public GpuTest {
 protected:
  ColorBlendTest() : walk_(device()) {
    std::mt19937 random(7);
    Frame frame = *frameOf(scene_);
    auto bytes = std::make_shared<std::vector<uint8_t>>(size_t{kWidth} * kHeight * 4);
    for (uint8_t& byte : *bytes) byte = uint8_t(random());
    // Every code once, and the ends of the range beside each other.
    for (size_t i = 0; i < kWidth; ++i) (*bytes)[4 * i] = uint8_t(i);
    for (size_t i = 0; i < kWidth; ++i) (*bytes)[4 * (kWidth + i)] = i % 2 == 0 ? 0 : 255;
    frame.sources[0][0].color = bytes;
    codes_ = bytes;
    slot_ = walk_.build(frame);
  }

  // Farthest from the mean of the samples around, in codes, where no px is cut off by the border.
  double worstError(double shift_x_px, double shift_y_px) {
    oracle::OutputView view = oracle::ownView(scene_);
    view.position_m.x = shift_x_px / (view.pinhole.focal_px.x * kInvZ);
    view.position_m.y = -shift_y_px / (view.pinhole.focal_px.y * kInvZ);
    const TracedView traced = walk_.trace(*slot_, {view}, kTolerance_px).front();
    double worst = 0;
    for (int row = 0; row + 1 < kHeight; ++row) {
      for (int column = 0; column + 1 < kWidth; ++column) {
        for (size_t channel = 0; channel < 3; ++channel) {
          const double expected = meanAt(column, row, channel, shift_x_px, shift_y_px);
          const double actual = 255.0 * traced.srgb[traced.index(column, row)][channel];
          worst = std::max(worst, std::abs(actual - expected));
        }
      }
    }
    return worst;
  }

 private:
  double lightAt(int column, int row, size_t channel) const {
    return linearFrom((*codes_)[(size_t(row) * kWidth + size_t(column)) * 4 + channel] / 255.0);
  }

  double meanAt(int column, int row, size_t channel, double share_x, double share_y) const {
    const double above =
        std::lerp(lightAt(column, row, channel), lightAt(column + 1, row, channel), share_x);
    const double below = std::lerp(lightAt(column, row + 1, channel),
                                   lightAt(column + 1, row + 1, channel), share_x);
    return 255 * srgbFrom(std::lerp(above, below, share_y));
  }

  const oracle::Scene scene_ = oracle::planeScene({0, 0, kInvZ}, kWidth, kHeight);
  SharedBytes codes_;
  WalkUnderTest walk_;
  std::unique_ptr<StructureSlot> slot_;
};

TEST_F(ColorBlendTest, everyCodeSurvives) {
  EXPECT_LE(worstError(0, 0), kCodeTolerance);
}

TEST_F(ColorBlendTest, meansAreThoseOfLinearLight) {
  for (const double share : {0.125, 0.25, 0.5, 0.75, 0.875}) {
    EXPECT_LE(worstError(share, 0), kBlendTolerance) << share << " px to the right";
    EXPECT_LE(worstError(0, share), kBlendTolerance) << share << " px down";
    EXPECT_LE(worstError(share, 0.375), kBlendTolerance) << share << " px to the right, and down";
  }
}

}  // namespace
}  // namespace viewloom
