// SPDX-License-Identifier: Apache-2.0
#include "base/log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace viewloom::log_test {
namespace {

TEST(Log, writesLinesFromItsLevelUpwards) {
  setLogLevel(logLevelOf("warn"));
  testing::internal::CaptureStderr();
  log(LogLevel::kInfo, "quiet ", 1);
  log(LogLevel::kError, "loud ", 2);
  EXPECT_THAT(testing::internal::GetCapturedStderr(),
              testing::AllOf(testing::HasSubstr("error loud 2\n"),
                             testing::Not(testing::HasSubstr("quiet"))));
  setLogLevel(LogLevel::kInfo);
}

// Names of streams and of devices come from elsewhere.
TEST(Log, writesNoControlCharacters) {
  testing::internal::CaptureStderr();
  log(LogLevel::kInfo, "stream \033[2Ja\nb");
  EXPECT_THAT(testing::internal::GetCapturedStderr(),
              testing::HasSubstr("info stream \\x1b[2Ja\\x0ab\n"));
}

TEST(Log, knowsItsLevelsByName) {
  EXPECT_EQ(logLevelOf("trace"), LogLevel::kTrace);
  EXPECT_EQ(logLevelOf("off"), LogLevel::kOff);
  EXPECT_EQ(logLevelOf("shout"), LogLevel::kInfo);
}

}  // namespace
}  // namespace viewloom::log_test
