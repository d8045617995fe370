// SPDX-License-Identifier: Apache-2.0
// Displays of the synthetic frame, rendered, for tests that work their rays out one by one.
#pragma once

#include <cstdlib>
#include <iostream>

#include <gtest/gtest.h>

#include "gpu/gathering_places.h"
#include "support/test_frames.h"

namespace viewloom {

inline constexpr SizePx kSource_px{320, 180};
// Share of px whose rays graze a silhouette, like rays that were rounded otherwise.
inline constexpr double kTiedShareMax = 2e-3;
// Codes that rounding may move a colour by inside a surface.
inline constexpr int kCodeTolerance = 1;

class RenderedDisplay : public GatheringTest {
 protected:
  void SetUp() override {
    GatheringTest::SetUp();
    if (IsSkipped()) return;
    renderer_ = &rendererAt(GatheringPlace::kHost);
    renderer_->build(*test::syntheticFrame(1, kSource_px));
  }

  RenderedAtlas render(const DisplaySpec& spec) {
    auto completed = completeDisplaySpec(spec);
    EXPECT_TRUE(completed.ok()) << completed.status();
    auto atlas = renderer_->render(*completed, {.mask = true}, [](uint32_t, uint32_t) {});
    EXPECT_TRUE(atlas.ok()) << atlas.status();
    return *std::move(atlas);
  }

  OfflineRenderer* renderer_ = nullptr;
};

inline int channelOf(uint32_t rgba, int channel) {
  return int(rgba >> (8 * channel) & 0xff);
}

// Share of all channels of all px that are further apart than rounding takes them.
template <typename Expected>
double differingShare(const RenderedAtlas& atlas, const Expected& expected) {
  size_t differing = 0;
  const SizePx size_px = atlas.layout->size_px;
  for (uint32_t y = 0; y < size_px.height; ++y) {
    for (uint32_t x = 0; x < size_px.width; ++x) {
      for (int channel = 0; channel < 3; ++channel) {
        const int got = channelOf(atlas.color[size_t{y} * size_px.width + x], channel);
        differing += std::abs(got - expected(x, y, channel)) > kCodeTolerance;
      }
    }
  }
  const double share = double(differing) / double(3 * size_px.area());
  std::cout << "differing share: " << share << "\n";
  return share;
}

// The colour of a px of a view of an atlas.
inline uint32_t colorAt(const RenderedAtlas& atlas, uint32_t view, uint32_t x, uint32_t y) {
  const TileOrigin origin = atlas.layout->tileOrigin(view);
  return atlas.color[size_t{origin.y_px + y} * atlas.layout->size_px.width + origin.x_px + x];
}

}  // namespace viewloom
