// SPDX-License-Identifier: Apache-2.0
#include "admission/request_boundary.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <new>
#include <stdexcept>
#include <string>

namespace viewloom::request_boundary_test {
namespace {

using testing::HasSubstr;
using testing::Not;

absl::Status thrown(const char* what) {
  return unlessThrown([what]() -> absl::Status { throw std::runtime_error(what); });
}

TEST(RequestBoundary, leavesResultsAlone) {
  EXPECT_TRUE(unlessThrown([] { return absl::OkStatus(); }).ok());
  EXPECT_EQ(*unlessThrown([] { return absl::StatusOr<int>(7); }), 7);
}

TEST(RequestBoundary, refusesForWantOfMemory) {
  const absl::Status status = unlessThrown([]() -> absl::Status { throw std::bad_alloc(); });
  EXPECT_EQ(status.code(), absl::StatusCode::kResourceExhausted);
  EXPECT_THAT(std::string(status.message()), HasSubstr("try again later"));
}

TEST(RequestBoundary, tellsTheClientNothingOfTheException) {
  const absl::Status status = thrown("secret");
  EXPECT_EQ(status.code(), absl::StatusCode::kInternal);
  EXPECT_THAT(std::string(status.message()), Not(HasSubstr("secret")));
}

// In one process with the test above: its line may have been written less than a second before.
TEST(RequestBoundary, logsAFloodOnce) {
  testing::internal::CaptureStderr();
  for (int i = 0; i < 1000; ++i) EXPECT_FALSE(thrown("flood\n").ok());
  const std::string text = testing::internal::GetCapturedStderr();
  EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 2) << text;
  EXPECT_THAT(text, Not(HasSubstr("flood\n")));
}

}  // namespace
}  // namespace viewloom::request_boundary_test
