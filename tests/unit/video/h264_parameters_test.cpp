// SPDX-License-Identifier: Apache-2.0
#include "video/h264_parameters.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "video/annex_b.h"

namespace viewloom::test::h264_parameters_test {
namespace {

using testing::HasSubstr;

// Baseline, level 1.0, 16x16 px, without usability information.
const std::vector<uint8_t> kSmallest = {0x67, 0x42, 0xC0, 0x0A, 0xDA, 0x79};

TEST(AnnexB, findsUnitsBetweenStartCodes) {
  const std::vector<uint8_t> stream = {9, 0, 0, 0, 1, 0x67, 1, 0, 0, 1, 0, 0, 1, 0x65, 2, 0, 0};
  const std::vector<NalUnit> units = nalUnits(stream);
  ASSERT_EQ(units.size(), 2u);
  EXPECT_EQ(units[0].type(), NalType::kSequenceParameters);
  EXPECT_THAT(units[0].bytes, testing::ElementsAre(0x67, 1));
  EXPECT_EQ(units[1].type(), NalType::kIdrSlice);
  EXPECT_THAT(units[1].bytes, testing::ElementsAre(0x65, 2));
}

TEST(AnnexB, findsNothingInOtherBytes) {
  EXPECT_TRUE(nalUnits({}).empty());
  EXPECT_TRUE(nalUnits(std::vector<uint8_t>{0, 0, 1}).empty());
  EXPECT_TRUE(nalUnits(std::vector<uint8_t>{0, 0, 2, 0x67}).empty());
}

TEST(H264Parameters, readsSizeAndLevel) {
  const auto parameters = parseH264Parameters(kSmallest);
  ASSERT_TRUE(parameters.ok()) << parameters.status();
  EXPECT_EQ(parameters->profile, 66);
  EXPECT_EQ(parameters->level, 10);
  EXPECT_EQ(parameters->size_px, (SizePx{16, 16}));
  EXPECT_EQ(parameters->reorder_count, std::nullopt);
  EXPECT_EQ(h264CodecString(*parameters), "avc1.42C00A");
}

TEST(H264Parameters, refusesWhatItCannotRead) {
  std::vector<uint8_t> other_profile = kSmallest;
  other_profile[1] = 244;
  const absl::Status refused = parseH264Parameters(other_profile).status();
  EXPECT_EQ(refused.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(refused.message()), HasSubstr("profile is 244"));
  EXPECT_FALSE(parseH264Parameters(std::span(kSmallest).first(4)).ok());
  EXPECT_FALSE(parseH264Parameters({}).ok());
  EXPECT_FALSE(h264ParametersOf(kSmallest).ok()) << "no start code";
}

TEST(H264Parameters, survivesAnyBytes) {
  uint32_t state = 1;
  for (int round = 0; round < 20000; ++round) {
    std::vector<uint8_t> bytes = kSmallest;
    bytes.resize(4 + round % 40);
    for (size_t i = 4; i < bytes.size(); ++i) {
      state = state * 1664525 + 1013904223;
      bytes[i] = uint8_t(state >> 24);
    }
    const auto parameters = parseH264Parameters(bytes);
    EXPECT_TRUE(!parameters.ok() || parameters->size_px.area() > 0);
  }
}

TEST(H264Parameters, givesTheLowestLevelOfASize) {
  EXPECT_EQ(h264Level({16, 16}), 10u);
  EXPECT_EQ(h264Level({352, 288}), 11u);
  EXPECT_EQ(h264Level({840, 1120}), 32u);
  EXPECT_EQ(h264Level({1920, 1080}), 40u);
  EXPECT_EQ(h264Level({4096, 2176}), 51u);
  EXPECT_EQ(h264Level({3360, 3360}), 60u);
  EXPECT_EQ(h264Level({4096, 16}), 40u) << "a side of 256 macroblocks";
}

}  // namespace
}  // namespace viewloom::test::h264_parameters_test
