// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "commands/doctor_checks.h"
#include "service_video.h"

namespace viewloom::test::video_check_test {
namespace {

TEST(CheckVideo, triesEachEncoder) {
  const std::vector<Finding> findings = checkVideo(Config{});
  EXPECT_FALSE(hasProblem(findings));
  std::string openh264;
  for (const Finding& finding : findings) {
    EXPECT_EQ(finding.subject, "video");
    if (finding.what.starts_with("openh264")) openh264 = finding.what;
  }
  EXPECT_THAT(openh264, testing::MatchesRegex("openh264 .OpenH264 [0-9.]+.: [0-9.]+ dB, [0-9.]+ ms "
                                              "for 640x360 px"));
}

TEST(CheckVideo, findsANameThatNoEncoderHas) {
  Config config;
  config.pipeline.video_encoder = "h265";
  const std::vector<Finding> findings = checkVideo(config);
  EXPECT_TRUE(hasProblem(findings));
  EXPECT_THAT(findings.back().what,
              testing::StartsWith("pipeline.video_encoder: \"h265\": this program has no such "
                                  "encoder; accepted is auto, "));
}

TEST(ChooseVideoEncoder, endsTheServerForANameThatNoEncoderHas) {
  EXPECT_THROW(chooseVideoEncoder("h265"), std::runtime_error);
  EXPECT_THAT(chooseVideoEncoder("openh264")->text(), testing::StartsWith("openh264 (OpenH264 "));
}

}  // namespace
}  // namespace viewloom::test::video_check_test
