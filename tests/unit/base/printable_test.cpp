// SPDX-License-Identifier: Apache-2.0
#include "base/printable.h"

#include <gtest/gtest.h>

namespace viewloom::printable_test {
namespace {

TEST(Printable, leavesTextAsItIs) {
  EXPECT_EQ(printable("demo, 1.5 µm → 日本 🙂"), "demo, 1.5 µm → 日本 🙂");
}

TEST(Printable, showsControlCharactersInsteadOfSendingThem) {
  EXPECT_EQ(printable("a\033[31mred\a\r\n\t\x7f"), "a\\x1b[31mred\\x07\\x0d\\x0a\\x09\\x7f");
  EXPECT_EQ(printable("a\xc2\x9b"
                      "31m"),
            "a\\xc2\\x9b31m")
      << "CSI of eight bits";
  EXPECT_EQ(printable("x\xe2\x80\xaey"), "x\\xe2\\x80\\xaey") << "text turned about";
  EXPECT_EQ(printable(std::string("a\0b", 3)), "a\\x00b");
}

TEST(Printable, showsBytesThatAreNoText) {
  EXPECT_EQ(printable("\xff\xc3"), "\\xff\\xc3");
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80") << "half of a surrogate pair";
  EXPECT_EQ(printable("\xc0\xaf"), "\\xc0\\xaf") << "longer than needed";
}

TEST(Printable, keepsLinesWhereTheyAreWanted) {
  EXPECT_EQ(printable("a\n\tb\033", true), "a\n\tb\\x1b");
}

TEST(Printable, quotesTheBeginOfALongTextInWholeCharacters) {
  EXPECT_EQ(quotable("short"), "short");
  EXPECT_EQ(quotable("abcdef", 4), "abcd...");
  EXPECT_EQ(quotable("日本語", 7), "日本...");
  EXPECT_EQ(quotable("日本語", 9), "日本語");
  EXPECT_EQ(quotable("a\xff\xff\xff", 2), "a\\xff...");
  EXPECT_LE(quotable(std::string(100000, 'x')).size(), kQuotationBytesMax + 3);
}

}  // namespace
}  // namespace viewloom::printable_test
