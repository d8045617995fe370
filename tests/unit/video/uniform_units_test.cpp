// SPDX-License-Identifier: Apache-2.0
#include "video/uniform_units.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/video/sample_picture.h"
#include "video/annex_b.h"
#include "video/h264_parameters.h"
#include "video/openh264_encoder.h"
#include "video/unit_bits.h"
#include "video/unit_writer.h"

namespace viewloom::test::uniform_units_test {
namespace {

using Bytes = std::vector<uint8_t>;

Bytes coded(SizePx size_px, Reference reference) {
  auto encoder = OpenH264Encoder::make({.size_px = size_px});
  EXPECT_TRUE(encoder.ok()) << encoder.status();
  Bytes unit;
  for (const Reference each : {Reference::kNone, reference}) {
    const SamplePicture picture = SamplePicture::texture(size_px, each == reference ? 2 : 0);
    EXPECT_TRUE((*encoder)->encode(picture.video(), each, unit).ok());
  }
  return unit;
}

// A parameter set of 64x64 px without usability information.
Bytes parameterSet(uint8_t profile, uint32_t reference_count) {
  UnitWriter set;
  set.bits(0x67, 8);
  set.bits(profile, 8);
  set.bits(0, 8);
  set.bits(52, 8);
  set.number(0);
  set.number(4);
  set.number(0);
  set.number(6);
  set.number(reference_count);
  set.flag(false);
  set.number(3);
  set.number(3);
  for (const bool flag : {true, true, false, false}) set.flag(flag);
  return set.finish();
}

TEST(UnitWriter, writesWhatUnitBitsReads) {
  UnitWriter writer;
  for (uint32_t i = 0; i < 70; ++i) writer.number(i * i * 37);
  writer.bits(0, 32);
  writer.bits(0xFFFFFFFF, 32);
  const Bytes unit = writer.finish();
  UnitBits reader(unit);
  for (uint32_t i = 0; i < 70; ++i) EXPECT_EQ(reader.number(), i * i * 37);
  EXPECT_EQ(reader.bits(32), 0u);
  EXPECT_EQ(reader.bits(32), 0xFFFFFFFFu);
  EXPECT_TRUE(reader.isWhole());
  constexpr std::array<uint8_t, 3> kZeros = {0, 0, 0};
  EXPECT_EQ(std::search(unit.begin(), unit.end(), kZeros.begin(), kZeros.end()), unit.end());
}

TEST(UniformUnits, keepThoseOfOpenH264AsTheyAre) {
  for (const SizePx size_px : {SizePx{64, 48}, SizePx{322, 202}, SizePx{840, 1120}}) {
    for (const Reference reference : {Reference::kNone, Reference::kPictureBefore}) {
      const Bytes unit = coded(size_px, reference);
      Bytes uniform;
      const absl::Status status =
          writeUniformUnit(unit, size_px, reference == Reference::kNone, uniform);
      EXPECT_TRUE(status.ok()) << status;
      EXPECT_EQ(uniform, unit);
    }
  }
}

TEST(UniformUnits, sayColorLevelAndOrder) {
  const auto set = uniformParameterSet(parameterSet(77, 1), {64, 64});
  ASSERT_TRUE(set.ok()) << set.status();
  const auto parameters = parseH264Parameters(*set);
  ASSERT_TRUE(parameters.ok()) << parameters.status();
  EXPECT_EQ(h264CodecString(*parameters), codedVideoString({64, 64}));
  EXPECT_EQ(parameters->color, kVideoColor);
  EXPECT_EQ(parameters->reorder_count, 0u);
  EXPECT_EQ(parameters->reference_count, 1u);
}

TEST(UniformUnits, refuseSetsThatWouldNotBeTrue) {
  EXPECT_THAT(std::string(uniformParameterSet(parameterSet(66, 1), {64, 64}).status().message()),
              testing::HasSubstr("its profile is 66; served is main (77)"));
  EXPECT_THAT(std::string(uniformParameterSet(parameterSet(77, 2), {64, 64}).status().message()),
              testing::HasSubstr("a picture refers to 2 others"));
  EXPECT_THAT(std::string(uniformParameterSet(parameterSet(77, 1), {64, 32}).status().message()),
              testing::HasSubstr("its pictures have 64x64 px instead of 64x32"));
}

TEST(UniformUnits, leaveOutSupplementsAndDelimiters) {
  const Bytes unit = coded({64, 48}, Reference::kNone);
  Bytes padded = {0, 0, 0, 1, 9, 0xF0, 0, 0, 1, 6, 5, 1, 7, 0x80};
  padded.insert(padded.end(), unit.begin(), unit.end());
  Bytes uniform;
  EXPECT_TRUE(writeUniformUnit(padded, {64, 48}, true, uniform).ok());
  EXPECT_EQ(uniform, unit);
}

TEST(UniformUnits, refuseWhatIsNoWholePicture) {
  const Bytes unit = coded({64, 48}, Reference::kNone);
  const std::vector<NalUnit> units = nalUnits(unit);
  Bytes out;
  EXPECT_FALSE(writeUniformUnit({}, {64, 48}, true, out).ok());
  const Bytes slice = {0, 0, 1, 0x65, 0x88};
  EXPECT_THAT(std::string(writeUniformUnit(slice, {64, 48}, true, out).message()),
              testing::HasSubstr("no parameter sets"));
  EXPECT_THAT(
      std::string(writeUniformUnit(coded({64, 48}, Reference::kPictureBefore), {64, 48}, true, out)
                      .message()),
      testing::HasSubstr("refers to another"));
}

}  // namespace
}  // namespace viewloom::test::uniform_units_test
