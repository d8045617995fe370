// SPDX-License-Identifier: Apache-2.0
// Access units of a moving texture, for tests of files.
#pragma once

#include <vector>

#include <gtest/gtest.h>

#include "support/video/sample_picture.h"
#include "video/openh264_encoder.h"

namespace viewloom::test {

inline constexpr SizePx kMovieSize_px{96, 64};

// Every `sync_interval`th picture refers to no other.
inline std::vector<std::vector<uint8_t>> codedMovie(int count, int sync_interval) {
  auto encoder = OpenH264Encoder::make({.size_px = kMovieSize_px});
  EXPECT_TRUE(encoder.ok()) << encoder.status();
  std::vector<std::vector<uint8_t>> units;
  for (int i = 0; i < count; ++i) {
    const bool is_sync = i % sync_interval == 0;
    units.emplace_back();
    const absl::Status coded =
        (*encoder)->encode(SamplePicture::texture(kMovieSize_px, 2 * i).video(),
                           is_sync ? Reference::kNone : Reference::kPictureBefore, units.back());
    EXPECT_TRUE(coded.ok()) << coded;
  }
  return units;
}

}  // namespace viewloom::test
