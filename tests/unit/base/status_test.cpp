// SPDX-License-Identifier: Apache-2.0
#include "base/status.h"

#include <gtest/gtest.h>

namespace viewloom::status_test {
namespace {

TEST(FieldError, namesTheFieldInTextAndByItself) {
  const absl::Status status = invalidField("header.number", "is 0");
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(status.message(), "header.number: is 0");
  EXPECT_EQ(fieldOf(status), "header.number");
}

TEST(FieldError, growsItsPathFromTheInside) {
  const absl::Status inner =
      fieldError(absl::StatusCode::kResourceExhausted, "size", "is too large");
  const absl::Status outer = withFieldPrefix(withFieldPrefix(inner, "planes[1]"), "header");
  EXPECT_EQ(outer.code(), absl::StatusCode::kResourceExhausted);
  EXPECT_EQ(outer.message(), "header.planes[1].size: is too large");
  EXPECT_EQ(fieldOf(outer), "header.planes[1].size");
}

TEST(FieldError, putsNoDotBeforeAnIndex) {
  EXPECT_EQ(fieldOf(withFieldPrefix(invalidField("[2].size", "is 0"), "layers")), "layers[2].size");
}

TEST(FieldError, givesAFieldToAStatusWithoutOne) {
  const absl::Status status = withFieldPrefix(absl::InvalidArgumentError("is torn"), "chunk.data");
  EXPECT_EQ(status.message(), "chunk.data: is torn");
  EXPECT_EQ(fieldOf(status), "chunk.data");
  EXPECT_EQ(fieldOf(absl::InvalidArgumentError("is torn")), "");
}

TEST(FieldError, leavesOkAlone) {
  EXPECT_TRUE(withFieldPrefix(absl::OkStatus(), "header").ok());
}

}  // namespace
}  // namespace viewloom::status_test
