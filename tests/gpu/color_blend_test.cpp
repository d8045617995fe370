// SPDX-License-Identifier: Apache-2.0
// Opaque 8-bit colour between samples, against means of the codes taken in double precision.
#include <algorithm>
#include <cmath>
#include <random>

#include <glm/gtc/packing.hpp>

#include "gpu/walk_under_test.h"
#include "oracle/analytic_scenes.h"
#include "support/srgb_transfer.h"
#include "support/test_device.h"

namespace viewloom::color_blend_test {
namespace {

constexpr int kWidth = 256;
constexpr int kHeight = 64;
constexpr double kInvZ = 0.25;
constexpr double kTolerance_px = 0.05;
// In codes, of what is not rounded yet: positions have 1/256 px, so along each axis a share is off
// by up to 1/512, of differences of up to 255.
constexpr double kBlendTolerance = 2 * 255.0 / 512;
constexpr double kCodeTolerance = 1e-3;  // of a code that is not blended: binary32

class ColorBlendTest : public GpuTest {
 protected:
  ColorBlendTest() {
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

  const oracle::Scene scene_ = oracle::planeScene({0, 0, kInvZ}, kWidth, kHeight);
  WalkUnderTest& walk_ = shared<WalkUnderTest>();

 private:
  double codeAt(int column, int row, size_t channel) const {
    return (*codes_)[(size_t(row) * kWidth + size_t(column)) * 4 + channel];
  }

  double meanAt(int column, int row, size_t channel, double share_x, double share_y) const {
    const double above =
        std::lerp(codeAt(column, row, channel), codeAt(column + 1, row, channel), share_x);
    const double below =
        std::lerp(codeAt(column, row + 1, channel), codeAt(column + 1, row + 1, channel), share_x);
    return std::lerp(above, below, share_y);
  }

  SharedBytes codes_;
  std::unique_ptr<StructureSlot> slot_;
};

TEST_F(ColorBlendTest, everyCodeSurvives) {
  EXPECT_LE(worstError(0, 0), kCodeTolerance);
}

TEST_F(ColorBlendTest, meansAreThoseOfTheCodes) {
  for (const double share : {0.125, 0.25, 0.5, 0.75, 0.875}) {
    EXPECT_LE(worstError(share, 0), kBlendTolerance) << share << " px to the right";
    EXPECT_LE(worstError(0, share), kBlendTolerance) << share << " px down";
    EXPECT_LE(worstError(share, 0.375), kBlendTolerance) << share << " px to the right, and down";
  }
}

// Colour that is not 8-bit sRGB is kept as roots of light in 11, 11 and 10 bits.
TEST_F(ColorBlendTest, opaqueLightSurvives) {
  // In codes: half a step of blue is 0.12 of one, beyond the toe; the fit of the curve, 0.07.
  constexpr double kLightTolerance = 0.2;
  Frame frame = *frameOf(scene_);
  auto halves = std::make_shared<std::vector<uint8_t>>();
  for (int i = 0; i < kWidth * kHeight; ++i) {
    for (const double code : {double(i % kWidth), i / 65.0, 255 - i / 65.0, 0.0}) {
      const uint16_t half = glm::packHalf1x16(float(linearFrom(code / 255)));
      halves->insert(halves->end(), {uint8_t(half), uint8_t(half >> 8)});
    }
  }
  PlaneFormat& format = frame.format.sources[0].layers[0].color;
  format.encoding = PlaneEncoding::kRgba16f;
  format.transfer = ColorTransfer::kLinear;
  format.alpha = AlphaMode::kOpaque;
  frame.sources[0][0].color = halves;
  frame.sources[0][0].color_encoding = PlaneEncoding::kRgba16f;
  const TracedView traced =
      walk_.trace(*walk_.build(frame), {oracle::ownView(scene_)}, kTolerance_px).front();
  double worst = 0;
  for (int i = 0; i < kWidth * kHeight; ++i) {
    const double codes[] = {double(i % kWidth), i / 65.0, 255 - i / 65.0};
    for (size_t c = 0; c < 3; ++c) {
      worst = std::max(worst, std::abs(255 * traced.srgb[size_t(i)][c] - codes[c]));
    }
  }
  EXPECT_LE(worst, kLightTolerance);
}

}  // namespace
}  // namespace viewloom::color_blend_test
