// SPDX-License-Identifier: Apache-2.0
// Access units of a moving texture, for tests of files.
#pragma once

#include <vector>

#include <gtest/gtest.h>

#include "support/video/coded_texture.h"
#include "video/openh264_encoder.h"

namespace viewloom::test {

inline constexpr SizePx kMovieSize_px{96, 64};

// Every `sync_interval`th picture refers to no other.
inline std::vector<AccessUnit> codedMovie(int count, int sync_interval) {
  auto encoder = OpenH264Encoder::make({.size_px = kMovieSize_px});
  EXPECT_TRUE(encoder.ok()) << encoder.status();
  return codedTexture(**encoder, count, sync_interval);
}

}  // namespace viewloom::test
