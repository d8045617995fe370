// SPDX-License-Identifier: Apache-2.0
#include "lib/compress_frame.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "unit/client/predicted_oracle.h"

namespace viewloom::predict_plane_test {
namespace {

std::vector<uint8_t> littleEndian(const std::vector<uint16_t>& samples) {
  std::vector<uint8_t> bytes;
  for (const uint16_t sample : samples) {
    bytes.push_back(static_cast<uint8_t>(sample % 256));
    bytes.push_back(static_cast<uint8_t>(sample / 256));
  }
  return bytes;
}

void expectRoundTrip(const std::vector<uint16_t>& samples, uint32_t width, uint32_t height) {
  const std::vector<uint8_t> packed = predictPlane(littleEndian(samples), width, height);
  EXPECT_EQ(test::unpredict(packed, width, height), samples) << width << "x" << height;
}

TEST(PredictPlane, isUndoneExactlyForRandomSamplesOfAnySize) {
  std::mt19937 random(3);
  for (const auto& [width, height] :
       {std::pair{1U, 1U}, {1U, 8U}, {8U, 1U}, {5U, 7U}, {67U, 31U}}) {
    std::vector<uint16_t> samples(size_t{width} * height);
    for (uint16_t& sample : samples) sample = static_cast<uint16_t>(random());
    expectRoundTrip(samples, width, height);
  }
}

TEST(PredictPlane, isUndoneExactlyAtTheEndsOfTheRange) {
  std::mt19937 random(4);
  const uint16_t ends[] = {0, 1, 32767, 32768, 65534, 65535};
  std::vector<uint16_t> samples(40 * 30);
  for (uint16_t& sample : samples) sample = ends[random() % 6];
  expectRoundTrip(samples, 40, 30);
}

TEST(PredictPlane, leavesNothingOfASlantedPlane) {
  std::vector<uint16_t> samples;
  for (int y = 0; y < 20; ++y) {
    for (int x = 0; x < 30; ++x) samples.push_back(static_cast<uint16_t>(9000 + 41 * x - 77 * y));
  }
  expectRoundTrip(samples, 30, 20);
  const std::vector<uint8_t> packed = predictPlane(littleEndian(samples), 30, 20);
  for (size_t i = 0; i < packed.size(); ++i) {
    const bool is_inside = i % 30 > 0 && i / 30 % 20 > 0;
    if (is_inside) {
      ASSERT_EQ(packed[i], 0) << i;
    }
  }
}

}  // namespace
}  // namespace viewloom::predict_plane_test
