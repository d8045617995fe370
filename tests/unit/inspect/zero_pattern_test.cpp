// SPDX-License-Identifier: Apache-2.0
// Zeros of inverse depth: a sky lies together, measurements that failed lie anywhere.
#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "inspect/stored_numbers.h"

namespace viewloom::inspect::zero_pattern_test {
namespace {

constexpr uint32_t kWidth = 160, kHeight = 120;

bool isScattered(const std::function<float(uint32_t x, uint32_t y)>& number) {
  std::vector<float> stored;
  for (uint32_t y = 0; y < kHeight; ++y) {
    for (uint32_t x = 0; x < kWidth; ++x) stored.push_back(number(x, y));
  }
  return zeroPattern(stored, kWidth, kHeight).isScattered();
}

float ground(uint32_t /*x*/, uint32_t y) {
  return 10 + float(y);
}

TEST(ZeroPattern, seesPointsOfAScanner) {
  for (const double kept : {0.05, 0.2}) {
    std::mt19937 random(5);
    std::bernoulli_distribution is_kept(kept);
    EXPECT_TRUE(isScattered([&](uint32_t x, uint32_t y) {
      return is_kept(random) ? ground(x, y) : 0;
    })) << kept;
  }
  EXPECT_TRUE(isScattered([](uint32_t x, uint32_t y) { return y % 4 == 0 ? ground(x, y) : 0; }))
      << "lines of a scanner";
}

TEST(ZeroPattern, seesHolesOfAMatcher) {
  std::mt19937 random(6);
  std::bernoulli_distribution is_lost(0.03);
  EXPECT_TRUE(isScattered([&](uint32_t x, uint32_t y) {
    return is_lost(random) ? 0 : ground(x, y);
  })) << "single px";
  EXPECT_TRUE(isScattered([](uint32_t x, uint32_t y) {
    const bool is_hole = x % 20 < 7 && y % 15 < 5 && x > 20 && y > 15;
    return is_hole ? 0 : ground(x, y);
  })) << "holes of 7 x 5 px";
}

TEST(ZeroPattern, leavesSkiesAlone) {
  EXPECT_FALSE(isScattered(ground)) << "no zeros";
  EXPECT_FALSE(isScattered([](uint32_t, uint32_t) { return 0.0F; })) << "nothing but zeros";
  EXPECT_FALSE(isScattered([](uint32_t x, uint32_t y) { return y < 50 ? 0 : ground(x, y); }));
  // Towers and poles before the sky.
  EXPECT_FALSE(isScattered([](uint32_t x, uint32_t y) {
    return y < 60 && x % 12 > 1 && x / 20 % 2 == 0 ? 0 : ground(x, y);
  }));
  // Leaves, through which the sky shines, below an open sky.
  EXPECT_FALSE(isScattered([](uint32_t x, uint32_t y) {
    const bool is_leaves = y >= 40 && y < 70;
    return y < 40 || (is_leaves && x % 5 == 1 && y % 5 == 1) ? 0 : ground(x, y);
  }));
  // Two windows of a room.
  EXPECT_FALSE(isScattered([](uint32_t x, uint32_t y) {
    return y > 20 && y < 60 && x > 20 && x % 60 < 40 ? 0 : ground(x, y);
  }));
  // A black sky of a JPEG: 0 among small codes.
  std::mt19937 random(7);
  std::uniform_int_distribution<int> noise(0, 2);
  EXPECT_FALSE(isScattered(
      [&](uint32_t x, uint32_t y) { return y < 60 ? float(noise(random)) : ground(x, y); }));
}

TEST(ZeroPattern, takesTinyImages) {
  const std::vector<float> one{0};
  EXPECT_FALSE(zeroPattern(one, 1, 1).isScattered());
  const std::vector<float> row{1, 0, 1};
  EXPECT_FALSE(zeroPattern(row, 3, 1).isScattered());
}

}  // namespace
}  // namespace viewloom::inspect::zero_pattern_test
