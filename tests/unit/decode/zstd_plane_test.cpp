// SPDX-License-Identifier: Apache-2.0
#include "decode/zstd_plane.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "unit/decode/zstd_samples.h"

namespace viewloom::zstd_plane_test {
namespace {

using testing::HasSubstr;

std::vector<uint8_t> content(size_t count) {
  std::vector<uint8_t> bytes(count);
  for (size_t i = 0; i < count; ++i) bytes[i] = static_cast<uint8_t>(i * i / 7);
  return bytes;
}

TEST(ZstdPlane, inflatesToWhatWasPacked) {
  ZstdInflater inflater;
  std::vector<uint8_t> out;
  for (const size_t count : {1U, 1000U, 1000000U}) {
    const std::vector<uint8_t> packed = zstdFrame(content(count), ZstdSize::kStated);
    ASSERT_EQ(*ZstdInflater::contentBytes(packed, count), count);
    ASSERT_EQ(inflater.inflate(packed, count, out), absl::OkStatus());
    EXPECT_EQ(out, content(count));
  }
}

TEST(ZstdPlane, takesAFrameThatLeavesItsSizeOpen) {
  ZstdInflater inflater;
  std::vector<uint8_t> out;
  const std::vector<uint8_t> packed = zstdFrame(content(5000), ZstdSize::kOpen);
  ASSERT_TRUE(ZstdInflater::contentBytes(packed, 5000).ok());
  EXPECT_TRUE(inflater.inflate(packed, 5000, out).ok());
  EXPECT_EQ(out, content(5000));
}

TEST(ZstdPlane, refusesAnotherStatedSizeByItsHeader) {
  const std::vector<uint8_t> packed = zstdFrame(content(5000), ZstdSize::kStated);
  EXPECT_THAT(std::string(ZstdInflater::contentBytes(packed, 4999).status().message()),
              HasSubstr("inflates to 5000 bytes; accepted is 4999"));
  EXPECT_FALSE(ZstdInflater::contentBytes(packed, 5001).ok());
}

TEST(ZstdPlane, neverInflatesPastTheDeclaredSize) {
  ZstdInflater inflater;
  std::vector<uint8_t> out;
  // 64 MiB of zeros in a few kilobytes, and a header that does not say so.
  const std::vector<uint8_t> bomb = zstdFrame(std::vector<uint8_t>(64 << 20), ZstdSize::kOpen);
  ASSERT_LT(bomb.size(), 10000U);
  EXPECT_FALSE(inflater.inflate(bomb, 5000, out).ok());
  EXPECT_LE(out.capacity(), 5000U);
}

TEST(ZstdPlane, refusesLessThanDeclared) {
  ZstdInflater inflater;
  std::vector<uint8_t> out;
  const std::vector<uint8_t> packed = zstdFrame(content(100), ZstdSize::kOpen);
  EXPECT_THAT(std::string(inflater.inflate(packed, 101, out).message()),
              HasSubstr("inflates to 100 bytes; accepted is 101"));
}

TEST(ZstdPlane, wantsTheSizeStatedWhereNothingElseBoundsIt) {
  const std::vector<uint8_t> open = zstdFrame(content(100), ZstdSize::kOpen);
  EXPECT_FALSE(ZstdInflater::contentBytesUpTo(open, 1000).ok());
  const std::vector<uint8_t> stated = zstdFrame(content(100), ZstdSize::kStated);
  EXPECT_EQ(*ZstdInflater::contentBytesUpTo(stated, 100), 100U);
  EXPECT_FALSE(ZstdInflater::contentBytesUpTo(stated, 99).ok());
}

TEST(ZstdPlane, refusesEveryTruncationAndWhatFollowsTheFrame) {
  ZstdInflater inflater;
  std::vector<uint8_t> packed = zstdFrame(content(3000), ZstdSize::kStated);
  for (size_t count = 0; count < packed.size(); ++count) {
    const std::vector<uint8_t> part(packed.begin(), packed.begin() + static_cast<long>(count));
    ASSERT_FALSE(ZstdInflater::contentBytes(part, 3000).ok()) << count;
  }
  packed.push_back(0);
  EXPECT_THAT(std::string(ZstdInflater::contentBytes(packed, 3000).status().message()),
              HasSubstr("1 bytes follow the zstd frame"));
}

}  // namespace
}  // namespace viewloom::zstd_plane_test
