// SPDX-License-Identifier: Apache-2.0
#include "video/encoder_probe.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "unit/video/planned_encoder.h"

namespace viewloom::test::encoder_probe_test {
namespace {

std::string failureOf(const EncoderPlan& plan) {
  const EncoderProbe probe = probeVideoEncoder(plannedKind("planned", plan));
  EXPECT_EQ(probe.name, "planned");
  return std::string(probe.status.message());
}

TEST(EncoderProbe, passesOpenH264) {
  const EncoderProbe probe = probeVideoEncoder(openH264Kind());
  EXPECT_TRUE(probe.status.ok()) << probe.status;
  EXPECT_EQ(probe.name, "openh264");
  EXPECT_THAT(probe.library, testing::StartsWith("OpenH264 2."));
  EXPECT_GT(probe.psnr_db, 40);
  EXPECT_LT(probe.psnr_db, 60);
  EXPECT_GT(probe.picture_ms, 0);
}

TEST(EncoderProbe, saysWhyAnEncoderCannotBeMade) {
  const EncoderProbe probe = probeVideoEncoder(missingKind("missing"));
  EXPECT_EQ(probe.status.message(), "there is no such device");
}

TEST(EncoderProbe, findsAnEncoderThatFailsLater) {
  EXPECT_EQ(failureOf(failingFrom(5)), "the device is lost");
}

TEST(EncoderProbe, findsPlanesThatAreExchanged) {
  EncoderPlan plan;
  plan.picture = [](VideoPicture given) {
    std::swap(given.cb, given.cr);
    return given;
  };
  EXPECT_THAT(failureOf(plan), testing::EndsWith(" dB; expected are at least 37 dB"));
}

TEST(EncoderProbe, findsPicturesThatReferToOthersUnasked) {
  EncoderPlan always;
  always.reference = [](Reference) { return Reference::kNone; };
  EXPECT_THAT(failureOf(always), testing::HasSubstr("chooses itself"));
  EncoderPlan never;  // but for the first
  never.reference = [](Reference) { return Reference::kPictureBefore; };
  EXPECT_THAT(failureOf(never), testing::HasSubstr("chooses itself"));
}

TEST(EncoderProbe, findsPicturesThatComeLate) {
  EncoderPlan plan;
  plan.after = [kept = std::vector<uint8_t>()](std::vector<uint8_t>& unit) mutable {
    std::swap(kept, unit);
  };
  EXPECT_NE(failureOf(plan), "");
}

TEST(EncoderProbe, findsAnotherLevel) {
  EncoderPlan plan;
  plan.after = [](std::vector<uint8_t>& unit) {
    constexpr size_t kLevel = 7;  // behind the start code
    if ((unit[4] & 0x1F) == 7) unit[kLevel] = 51;
  };
  EXPECT_EQ(failureOf(plan), "its stream is avc1.4D4C33 instead of avc1.4D4C16");
}

}  // namespace
}  // namespace viewloom::test::encoder_probe_test
