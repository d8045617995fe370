// SPDX-License-Identifier: Apache-2.0
#include "decode/predicted_plane.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "decode/plane_decoder.h"
#include "unit/decode/predicted_samples.h"
#include "unit/decode/zstd_samples.h"

namespace viewloom::predicted_plane_test {
namespace {

using testing::HasSubstr;
using Bytes = std::vector<uint8_t>;

// Restores what the letter of the proto makes of the samples.
void expectRestored(const std::vector<uint16_t>& samples, SizePx size_px) {
  const int width = static_cast<int>(size_px.width);
  const int height = static_cast<int>(size_px.height);
  Bytes out(3, 99);  // what an earlier plane left
  restorePredicted(predictedBytes(samples, width, height), size_px, out);
  EXPECT_EQ(out, littleEndian(samples)) << width << "x" << height;
}

TEST(PredictedPlane, restoresRandomSamplesOfAnySize) {
  std::mt19937 random(5);
  for (const SizePx size_px : {SizePx{1, 1}, {1, 9}, {9, 1}, {2, 2}, {7, 5}, {64, 33}}) {
    std::vector<uint16_t> samples(size_px.area());
    for (uint16_t& sample : samples) sample = static_cast<uint16_t>(random());
    expectRestored(samples, size_px);
  }
}

TEST(PredictedPlane, restoresSamplesOnlyAtTheEndsOfTheirRange) {
  std::mt19937 random(6);
  const uint16_t ends[] = {0, 1, 32767, 32768, 65534, 65535};
  std::vector<uint16_t> samples(31 * 17);
  for (uint16_t& sample : samples) sample = ends[random() % 6];
  expectRestored(samples, {31, 17});
}

TEST(PredictedPlane, isAllZerosBehindTheFirstRowAndColumnOfASlantedPlane) {
  std::vector<uint16_t> samples;
  for (int y = 0; y < 6; ++y) {
    for (int x = 0; x < 8; ++x) samples.push_back(static_cast<uint16_t>(500 + 30 * x - 70 * y));
  }
  const Bytes bytes = predictedBytes(samples, 8, 6);
  for (size_t i = 0; i < bytes.size(); ++i) {
    const size_t x = i % 8;
    const size_t y = i / 8 % 6;
    if (x > 0 && y > 0) {
      ASSERT_EQ(bytes[i], 0) << x << ", " << y;
    }
  }
  expectRestored(samples, {8, 6});
}

class PredictedPlaneTest : public testing::Test {
 protected:
  absl::StatusOr<SharedBytes> decode(Bytes wire) {
    return decoder_.decode(plane_, std::make_shared<const Bytes>(std::move(wire)));
  }
  std::string refusalOf(Bytes wire) {
    const absl::StatusOr<SharedBytes> plane = decode(std::move(wire));
    EXPECT_EQ(plane.status().code(), absl::StatusCode::kInvalidArgument);
    return std::string(plane.status().message());
  }

  const std::vector<uint16_t> samples_{1, 2, 3, 40000, 65535, 0};
  const Bytes predicted_ = predictedBytes(samples_, 3, 2);
  PlaneFormat plane_{.kind = PlaneKind::kDepth,
                     .encoding = PlaneEncoding::kDepthU16,
                     .size_px = {3, 2},
                     .compression = PlaneCompression::kPredictedZstd};
  BytePool pool_{8};
  PlaneDecoder decoder_{pool_};
};

TEST_F(PredictedPlaneTest, isInflatedAndRestored) {
  for (const ZstdSize size : {ZstdSize::kStated, ZstdSize::kOpen}) {
    const absl::StatusOr<SharedBytes> plane = decode(zstdFrame(predicted_, size));
    ASSERT_TRUE(plane.ok()) << plane.status();
    EXPECT_EQ(**plane, littleEndian(samples_));
  }
}

TEST_F(PredictedPlaneTest, holdsHalfFloatsAsTheirBits) {
  plane_.encoding = PlaneEncoding::kDepthF16;
  const absl::StatusOr<SharedBytes> plane = decode(zstdFrame(predicted_, ZstdSize::kStated));
  ASSERT_TRUE(plane.ok()) << plane.status();
  EXPECT_EQ(**plane, littleEndian(samples_));
}

TEST_F(PredictedPlaneTest, isRefusedWhenItsFrameIsCutShortOrHoldsAnotherSize) {
  const Bytes whole = zstdFrame(predicted_, ZstdSize::kStated);
  for (size_t count = 0; count < whole.size(); ++count) {
    EXPECT_FALSE(decode(Bytes(whole.begin(), whole.begin() + static_cast<long>(count))).ok());
  }
  for (const ZstdSize size : {ZstdSize::kStated, ZstdSize::kOpen}) {
    EXPECT_THAT(refusalOf(zstdFrame(Bytes(11), size)), HasSubstr("12"));
    EXPECT_THAT(refusalOf(zstdFrame(Bytes(13), size)), HasSubstr("12"));
    EXPECT_THAT(refusalOf(zstdFrame(Bytes(64 << 20), size)), HasSubstr("12")) << "a bomb";
  }
}

}  // namespace
}  // namespace viewloom::predicted_plane_test
