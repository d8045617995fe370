// SPDX-License-Identifier: Apache-2.0
#include "cli/user_words.h"

#include <gtest/gtest.h>

namespace viewloom::cli {
namespace {

TEST(UserWords, nameTheOptionOfAField) {
  EXPECT_EQ(inUserWords("display.quilt.preset: there is no \"x\""), "--preset: there is no \"x\"");
  EXPECT_EQ(inUserWords("quilt.columns: got 0"), "--columns: got 0");
}

TEST(UserWords, nameTheLayerOfAFrame) {
  EXPECT_EQ(inUserWords("sources[0].layers[1].depth: got 0 bytes"), "layer 2, depth: got 0 bytes");
  EXPECT_EQ(inUserWords("sources[2].camera: got nan"), "source 3, camera: got nan");
  EXPECT_EQ(inUserWords("sources[0]: no layers"), "the frame: no layers");
}

TEST(UserWords, leaveOtherMessagesAlone) {
  for (const char* text : {"no field", "a b: c", "stream: there is none", ": x", "sources[: x",
                           "sources[99999999999999999999].a: x"}) {
    EXPECT_EQ(inUserWords(text), text);
  }
}

}  // namespace
}  // namespace viewloom::cli
