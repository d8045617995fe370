// SPDX-License-Identifier: Apache-2.0
// Tone maps: what their curves promise, and that the device computes them.
#include "shared/tone_map.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <random>

#include <glm/gtc/packing.hpp>
#include <glm/gtc/type_precision.hpp>

#include "gpu/walk_under_test.h"
#include "oracle/analytic_scenes.h"
#include "support/srgb_transfer.h"
#include "support/test_device.h"

namespace viewloom::tone_map_test {
namespace {

using abi::vec3;

// sRGB-encoded; half floats, roots of 16 bits and the transfer curve: a fifth of an 8-bit step.
constexpr double kColorTolerance = 0.2 / 255;
constexpr uint32_t kMaps[] = {abi::kToneMapFilmic, abi::kToneMapAgx};

// So many stops from middle grey.
float stops(double count) {
  return float(0.18 * std::exp2(count));
}

TEST(ToneMap, keepsBlackAndMiddleGreyAndEndsInWhite) {
  for (const uint32_t map : kMaps) {
    EXPECT_EQ(abi::toneMapped(vec3(0), map), vec3(0));
    EXPECT_NEAR(abi::toneMapped(vec3(0.18F), map).x, 0.18, 1e-5);
    EXPECT_NEAR(abi::toneMapped(vec3(abi::kToneWhite), map).y, 1, 1e-5);
    EXPECT_NEAR(abi::toneMapped(vec3(3e38F), map).z, 1, 1e-5);
    // The slope is that of the scene around middle grey, in stops.
    const float above = abi::toneMapped(vec3(stops(0.1)), map).x;
    const float below = abi::toneMapped(vec3(stops(-0.1)), map).x;
    EXPECT_NEAR(std::log2(above / below), 0.2, 0.01);
  }
}

TEST(ToneMap, raisesGreysWithTheirLightAndLeavesThemGrey) {
  for (const uint32_t map : kMaps) {
    float before = 0;
    for (double stop = -12; stop < 6.4; stop += 0.01) {
      const vec3 grey = abi::toneMapped(vec3(stops(stop)), map);
      EXPECT_GT(grey.x, before) << stop;
      EXPECT_NEAR(grey.x, grey.y, 1e-6);
      EXPECT_NEAR(grey.x, grey.z, 1e-6);
      before = grey.x;
    }
    EXPECT_LE(before, 1);
  }
}

TEST(ToneMap, takesNoLightAwayFromBrighterColours) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> channel(0, 1);
  for (const uint32_t map : kMaps) {
    for (int i = 0; i < 200; ++i) {
      const vec3 color(channel(random), channel(random), channel(random));
      float before = 0;
      for (double stop = -8; stop < 8; stop += 0.1) {
        const vec3 shown = abi::toneMapped(color * stops(stop), map);
        const float sum = shown.x + shown.y + shown.z;
        EXPECT_GE(sum, before - 1e-5F) << map << " " << stop;
        EXPECT_TRUE(std::min({shown.x, shown.y, shown.z}) >= 0 &&
                    std::max({shown.x, shown.y, shown.z}) <= 1);
        before = sum;
      }
    }
  }
}

TEST(ToneMap, leadsBrightPrimariesToWhiteOnlyLikeAgx) {
  for (const vec3 primary : {vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1)}) {
    const auto least = [&](float light, uint32_t map) {
      const vec3 shown = abi::toneMapped(primary * light, map);
      return std::min({shown.x, shown.y, shown.z});
    };
    EXPECT_EQ(least(64, abi::kToneMapClip), 0);
    EXPECT_EQ(least(64, abi::kToneMapFilmic), 0);
    EXPECT_GT(least(8, abi::kToneMapAgx), least(1, abi::kToneMapAgx) + 0.2F);
    EXPECT_GT(least(64, abi::kToneMapAgx), 0.9F);
  }
}

TEST(ToneMap, bendsNoPrimaryOfAgxAtZero) {
  for (const vec3 color : {vec3(1, 0, 0), vec3(0, 1, 0), vec3(1, 1, 0), vec3(1, 0, 1)}) {
    float before = 0;
    for (double stop = -10; stop < 5; stop += 0.1) {
      const vec3 shown = abi::toneMapped(color * stops(stop), abi::kToneMapAgx);
      const float least = std::min({shown.x, shown.y, shown.z});
      EXPECT_GT(least, before) << "a channel that stays at 0 leaves it with a kink, at " << stop;
      before = least;
    }
  }
}

class ToneMapTest : public GpuTest {
 protected:
  ToneMapTest() {
    std::mt19937 random(9);
    std::uniform_real_distribution<float> stop(-10, 9);
    std::uniform_real_distribution<float> share(0, 1);
    for (size_t i = 0; i < size_t{kWidth} * kHeight; ++i) {
      vec3 light = vec3(share(random), share(random), share(random)) * stops(stop(random));
      if (i % 5 == 0) light = vec3(light.x);
      if (i % 5 == 1) light = vec3(0, light.y, 0);
      // Light as binary16 holds it.
      for (int c = 0; c < 3; ++c) light[c] = glm::unpackHalf1x16(glm::packHalf1x16(light[c]));
      lights_.push_back(light);
    }
  }

  // Colours of a view from the source's own place, sRGB-encoded.
  std::vector<LinearColor> shown(ToneMap map, ColorTransfer transfer, AlphaMode alpha,
                                 float coverage) {
    // Behind what does not cover all, a black wall.
    const oracle::Scene scene =
        coverage < 1
            ? oracle::stepScene({.at_origin = 0.5}, {.at_origin = 0.25}, 0, true, kWidth, kHeight)
            : oracle::planeScene({.at_origin = 0.5}, kWidth, kHeight);
    std::vector<LinearColor> colors(size_t(scene.planes.layer_count), {0, 0, 0, 1});
    Frame frame = *frameOf(scene, colors);
    PlaneFormat& color = frame.format.sources[0].layers[0].color;
    color.transfer = transfer;
    color.alpha = alpha;
    auto bytes = std::make_shared<std::vector<uint8_t>>(lights_.size() * 8);
    for (size_t i = 0; i < lights_.size(); ++i) {
      const glm::u16vec4 texel{glm::packHalf1x16(lights_[i].x), glm::packHalf1x16(lights_[i].y),
                               glm::packHalf1x16(lights_[i].z), glm::packHalf1x16(coverage)};
      std::memcpy(bytes->data() + 8 * i, &texel, 8);
    }
    frame.sources[0][0].color = bytes;
    frame.format.tone_map = map;
    const std::unique_ptr<StructureSlot> slot = walk_.build(frame);
    return walk_.trace(*slot, {oracle::ownView(scene)}, 0.05).front().srgb;
  }

  void expectShown(const std::vector<LinearColor>& shown, double gain,
                   const std::function<vec3(vec3)>& mapped) {
    double worst = 0;
    for (size_t i = 0; i < lights_.size(); ++i) {
      const vec3 light = mapped(lights_[i]);
      for (int c = 0; c < 3; ++c) {
        const double expected = srgbFrom(std::clamp(gain * double{light[c]}, 0.0, 1.0));
        worst = std::max(worst, std::abs(expected - double{shown[i][size_t(c)]}));
      }
    }
    EXPECT_LE(worst, kColorTolerance);
  }

  static constexpr int kWidth = 96;
  static constexpr int kHeight = 64;
  WalkUnderTest& walk_ = shared<WalkUnderTest>();
  std::vector<vec3> lights_;
};

TEST_F(ToneMapTest, isOnTheDeviceWhatItIsHere) {
  for (const ToneMap map : {ToneMap::kClip, ToneMap::kFilmic, ToneMap::kAgx}) {
    const auto mapped = [&](vec3 light) { return abi::toneMapped(light, uint32_t(map)); };
    expectShown(shown(map, ColorTransfer::kLinear, AlphaMode::kOpaque, 1), 1, mapped);
  }
}

// Half covered, before black.
TEST_F(ToneMapTest, isThatOfTheColourItselfWhereItIsPremultiplied) {
  for (const ToneMap map : {ToneMap::kFilmic, ToneMap::kAgx}) {
    const auto mapped = [&](vec3 light) { return abi::toneMapped(light, uint32_t(map)); };
    const auto divided = [&](vec3 light) { return abi::toneMapped(2.0F * light, uint32_t(map)); };
    expectShown(shown(map, ColorTransfer::kLinear, AlphaMode::kStraight, 0.5F), 0.5, mapped);
    expectShown(shown(map, ColorTransfer::kLinear, AlphaMode::kPremultiplied, 0.5F), 0.5, divided);
  }
}

TEST_F(ToneMapTest, leavesPlanesOfSrgbAsTheyAre) {
  const auto plain = shown(ToneMap::kClip, ColorTransfer::kSrgb, AlphaMode::kOpaque, 1);
  EXPECT_EQ(shown(ToneMap::kAgx, ColorTransfer::kSrgb, AlphaMode::kOpaque, 1), plain);
}

}  // namespace
}  // namespace viewloom::tone_map_test
