// SPDX-License-Identifier: Apache-2.0
// Quotients of integers that all devices make alike are those of IEEE 754.
#include <gtest/gtest.h>

#include <random>

#include "shared/histogram.h"
#include "shared/quotient.h"

namespace viewloom::quotient_test {
namespace {

constexpr int kPairCount = 1'000'000;

static_assert(abi::exactQuotient(1, 3) == 1.0F / 3.0F);
static_assert(abi::exactQuotient(0, 3) == 0);

// A positive number of any mantissa, 2^-32 to 2^32.
float anyOf(std::mt19937& random) {
  const uint32_t exponent = 127 - 32 + uint32_t(random() % 64);
  return abi::uintBitsToFloat(exponent << 23 | uint32_t(random() & 0x7fffffU));
}

TEST(ExactQuotientTest, isRoundedToNearestForAnyMantissas) {
  std::mt19937 random(1);
  for (int i = 0; i < kPairCount; ++i) {
    const float a = anyOf(random), b = anyOf(random);
    ASSERT_EQ(abi::exactQuotient(a, b), a / b) << a << " / " << b;
  }
}

// Quotients near 1, where the mantissa that is larger changes.
TEST(ExactQuotientTest, isRoundedToNearestForNeighbours) {
  std::mt19937 random(2);
  for (int i = 0; i < kPairCount; ++i) {
    const float a = anyOf(random);
    const float b = abi::uintBitsToFloat(abi::floatBitsToUint(a) + uint32_t(random() % 5) - 2);
    ASSERT_EQ(abi::exactQuotient(a, b), a / b) << a << " / " << b;
  }
}

// Places of an apron: whole numbers, up to two sides of the largest face.
TEST(ExactQuotientTest, isRoundedToNearestForPlacesOfAnApron) {
  for (int depth = 1; depth < 20; ++depth) {
    for (int rest = 0; rest <= 2 * depth; ++rest) {
      ASSERT_EQ(abi::exactQuotient(float(rest), float(2 * depth)), float(rest) / float(2 * depth));
    }
  }
  std::mt19937 random(3);
  for (int i = 0; i < kPairCount; ++i) {
    const float depth = float(1 + random() % 16400), rest = float(random() % 16400);
    ASSERT_EQ(abi::exactQuotient(rest, depth), rest / depth) << rest << " / " << depth;
  }
}

TEST(ExactQuotientTest, isRoundedToNearestForNoiseOfEveryBin) {
  for (uint32_t bin = 1; bin <= abi::kNoiseHistogramBinCount; ++bin) {
    const float end = abi::binStart(bin, abi::kNoiseMantissaBits);
    ASSERT_EQ(abi::exactQuotient(end, abi::kMedianPerSigma), end / abi::kMedianPerSigma) << bin;
  }
}

}  // namespace
}  // namespace viewloom::quotient_test
