// SPDX-License-Identifier: Apache-2.0
// Colour planes that are larger or smaller than the depth planes, and not alike: looked up by uv.
#include <cmath>

#include <glm/gtc/packing.hpp>

#include "gpu/walk_under_test.h"
#include "oracle/analytic_scenes.h"
#include "support/srgb_transfer.h"
#include "support/test_device.h"

namespace viewloom::color_size_test {
namespace {

constexpr double kTolerance_px = 0.05;

// Picture of every plane: light that grows from left to right and from top to bottom.
LinearColor lightAt(double u, double v) {
  return {float(u), float(v), 0.5f, 1.0f};
}

SharedBytes ramp(SizePx size_px) {
  auto bytes = std::make_shared<std::vector<uint8_t>>();
  for (uint32_t y = 0; y < size_px.height; ++y) {
    for (uint32_t x = 0; x < size_px.width; ++x) {
      const LinearColor light = lightAt((x + 0.5) / size_px.width, (y + 0.5) / size_px.height);
      for (const float channel : light) {
        const uint16_t half = glm::packHalf1x16(channel);
        bytes->push_back(uint8_t(half));
        bytes->push_back(uint8_t(half >> 8));
      }
    }
  }
  return bytes;
}

Frame withRamps(Frame frame, const std::vector<SizePx>& color_px) {
  for (size_t i = 0; i < color_px.size(); ++i) {
    PlaneFormat& format = frame.format.sources[0].layers[i].color;
    format.encoding = PlaneEncoding::kRgba16f;
    format.transfer = ColorTransfer::kLinear;
    format.size_px = color_px[i];
    frame.sources[0][i].color = ramp(color_px[i]);
    frame.sources[0][i].color_encoding = PlaneEncoding::kRgba16f;
  }
  return frame;
}

class ColorSizeTest : public GpuTest {
 protected:
  // The largest distance, in uv, of a hit's colour from the one that belongs there.
  double worstDistance(const std::vector<SizePx>& color_px) {
    const oracle::Scene scene =
        oracle::stepScene({0, 0, 1.0}, {1.0 / 4096, 0, 0.25}, 0, true, 64, 48);
    const std::unique_ptr<StructureSlot> slot = walk_.build(withRamps(*frameOf(scene), color_px));
    oracle::OutputView view = oracle::ownView(scene);
    view.position_m = {0.1, 0.05, 0.02};
    const TracedView traced = walk_.trace(*slot, {view}, kTolerance_px).front();
    double worst = 0;
    int hit_count = 0;
    int second_layer_count = 0;
    for (size_t i = 0; i < traced.records.size(); ++i) {
      const abi::RayRecord& record = traced.records[i];
      if (record.ray_class != abi::kClassHit && record.ray_class != abi::kClassHitAssumed) continue;
      ++hit_count;
      second_layer_count += record.layer == 1;
      const LinearColor expected = lightAt(record.x_px / 64.0, record.y_px / 48.0);
      for (size_t channel = 0; channel < 3; ++channel) {
        const double light = linearFrom(traced.srgb[i][channel]);
        worst = std::max(worst, std::abs(light - double{expected[channel]}));
      }
    }
    EXPECT_GT(hit_count, 500);
    EXPECT_GT(second_layer_count, 5);
    return worst;
  }

  WalkUnderTest& walk_ = shared<WalkUnderTest>();
};

// Interpolation is exact on a ramp but where taps fall away: at the border and at silhouettes the
// colour is that of a texel up to half of one away.
constexpr double kHalfTexel = 0.5;
constexpr double kRounding = 2e-3;  // binary16, and the fits of the sRGB curve

TEST_F(ColorSizeTest, smallerPlanesAreInterpolated) {
  EXPECT_LE(worstDistance({{32, 24}, {32, 24}}), kHalfTexel / 24 + kRounding);
}

TEST_F(ColorSizeTest, largerPlanesAreLookedUpWhereTheRayHits) {
  EXPECT_LE(worstDistance({{128, 96}, {128, 96}}), kHalfTexel / 96 + kRounding);
}

TEST_F(ColorSizeTest, layersOfDifferentSizesDoNotMixTheirRows) {
  // A tap that another layer continues is that layer's nearest texel: half of its own, too.
  EXPECT_LE(worstDistance({{32, 24}, {128, 96}}), 2 * kHalfTexel / 24 + kRounding);
  EXPECT_LE(worstDistance({{100, 75}, {40, 30}}), 2 * kHalfTexel / 30 + kRounding);
}

}  // namespace
}  // namespace viewloom::color_size_test
