// SPDX-License-Identifier: Apache-2.0
#include "base/json_nesting.h"

#include <gtest/gtest.h>

#include <string>

namespace viewloom::json_nesting_test {
namespace {

TEST(JsonNesting, countsListsAndObjects) {
  const std::string open(kJsonDepthMax, '[');
  EXPECT_FALSE(isNestedDeeply(open));
  EXPECT_TRUE(isNestedDeeply(open + '['));
  EXPECT_TRUE(isNestedDeeply(open + '{'));
  EXPECT_FALSE(isNestedDeeply(""));
}

TEST(JsonNesting, takesAnotherLimit) {
  EXPECT_FALSE(isNestedDeeply("[{}]", 2));
  EXPECT_TRUE(isNestedDeeply("[{}]", 1));
}

TEST(JsonNesting, countsWhatIsOpenAtATime) {
  std::string beside;
  for (size_t i = 0; i < 1000; ++i) beside += "[{}],";
  EXPECT_FALSE(isNestedDeeply(beside));
  EXPECT_FALSE(isNestedDeeply("]]]]" + std::string(kJsonDepthMax, '{')));
}

TEST(JsonNesting, leavesTextsAlone) {
  const std::string many(1000, '[');
  EXPECT_FALSE(isNestedDeeply("{\"a\": \"" + many + "\"}"));
  EXPECT_FALSE(isNestedDeeply("{\"a\\\"" + many + "\": 1}"));
  EXPECT_TRUE(isNestedDeeply("{\"a\\\\\": " + many + "}"));
}

}  // namespace
}  // namespace viewloom::json_nesting_test
