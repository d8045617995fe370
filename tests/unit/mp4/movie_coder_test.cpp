// SPDX-License-Identifier: Apache-2.0
#include "mp4/movie_coder.h"

#include <gtest/gtest.h>

#include "video/annex_b.h"
#include "video/openh264_decoder.h"

namespace viewloom::test::movie_coder_test {
namespace {

constexpr int64_t kMs = 1'000'000;
constexpr AtlasTiles kAtlas = {.atlas_px = {64, 48}, .tile_px = {32, 24}, .columns = 2, .rows = 2};

bool isSync(std::span<const uint8_t> access_unit) {
  for (const NalUnit& unit : nalUnits(access_unit)) {
    if (unit.type() == NalType::kIdrSlice) return true;
  }
  return false;
}

TEST(MovieCoder, beginsAnewEveryTwoSeconds) {
  const auto coder = MovieCoder::make({.atlas = kAtlas, .video = *fitVideoTiles(kAtlas)});
  ASSERT_TRUE(coder.ok()) << coder.status();
  const auto decoder = *OpenH264Decoder::make();
  const std::vector<uint8_t> rgb(64 * 48 * 3, 90);
  std::vector<bool> syncs;
  for (const int64_t time_ns : {0 * kMs, 100 * kMs, 1999 * kMs, 2000 * kMs, 2100 * kMs}) {
    const auto unit = (*coder)->code({.samples = rgb.data()}, time_ns);
    ASSERT_TRUE(unit.ok()) << unit.status();
    syncs.push_back(isSync(*unit));
    const auto picture = decoder->decode(*unit, {64, 48});
    ASSERT_TRUE(picture.ok()) << picture.status();
    EXPECT_NEAR(picture->y[0], 90, 1);
  }
  EXPECT_EQ(syncs, (std::vector<bool>{true, false, false, true, false}));
  const auto again = (*coder)->codeAgain(2200 * kMs);
  ASSERT_TRUE(again.ok()) << again.status();
  EXPECT_LT(again->size(), 60U) << "nothing moves";
}

}  // namespace
}  // namespace viewloom::test::movie_coder_test
