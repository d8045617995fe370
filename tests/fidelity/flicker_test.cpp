// SPDX-License-Identifier: Apache-2.0
// Stacks of pictures whose flicker is known.
#include "fidelity/flicker.h"

#include <gtest/gtest.h>

namespace viewloom::fidelity::flicker_test {
namespace {

constexpr SizePx kSize = {6, 4};

ScoredImage grey(float value) {
  return {.size_px = kSize, .rgb = std::vector<float>(3 * kSize.area(), value)};
}

const std::vector<ScoredImage> kTruth = {grey(0.1F), grey(0.5F), grey(0.2F)};

TEST(Flicker, isNothingWhereErrorsStayTheSame) {
  const std::vector<ScoredImage> off = {grey(0.15F), grey(0.55F), grey(0.25F)};
  EXPECT_EQ(flicker(kTruth, kTruth, {0, kSize}), 0);
  EXPECT_NEAR(flicker(off, kTruth, {0, kSize}), 0, 1e-4);
}

TEST(Flicker, countsAnErrorOfOneViewAsItComesAndAsItGoes) {
  const std::vector<ScoredImage> flash = {grey(0.1F), grey(0.6F), grey(0.2F)};
  EXPECT_NEAR(flicker(flash, kTruth, {0, kSize}), 25.5, 1e-3);
  const std::vector<ScoredImage> last = {grey(0.1F), grey(0.5F), grey(0.3F)};
  EXPECT_NEAR(flicker(last, kTruth, {0, kSize}), 25.5 / 2, 1e-3);
}

TEST(Flicker, isTheMeanOverPixelsAndChannelsInside) {
  std::vector<ScoredImage> got = kTruth;
  got[2].rgb[3 * (1 * kSize.width + 1) + 2] += 0.5F;  // one channel of a pixel inside
  got[2].rgb[0] += 0.5F;                              // in the border
  const double inside_px = 4 * 2;
  EXPECT_NEAR(flicker(got, kTruth, {1, kSize}), 255 * 0.5 / (3 * inside_px * 2), 1e-4);
}

}  // namespace
}  // namespace viewloom::fidelity::flicker_test
