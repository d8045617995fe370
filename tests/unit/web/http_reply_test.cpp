// SPDX-License-Identifier: Apache-2.0
#include "web/http_reply.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace viewloom::http_reply_test {
namespace {

TEST(ContentDisposition, namesAFileAsItIs) {
  EXPECT_EQ(contentDisposition("demo_qs8x6a0.75.jpg"), "inline; filename=\"demo_qs8x6a0.75.jpg\"");
}

TEST(ContentDisposition, keepsForeignLettersBesideAPlainName) {
  EXPECT_EQ(contentDisposition("B\xc3\xa4r.jpg"),
            "inline; filename=\"B__r.jpg\"; filename*=UTF-8''B%c3%a4r.jpg");
}

TEST(ContentDisposition, leavesNothingThatEndsTheHeaderOrThePathOrHidesTheFile) {
  EXPECT_EQ(contentDisposition("a\"b\r\nc.jpg"),
            "inline; filename=\"a_b__c.jpg\"; filename*=UTF-8''a%22b%0d%0ac.jpg");
  EXPECT_EQ(contentDisposition("../etc/x"),
            "inline; filename=\"_.._etc_x\"; filename*=UTF-8''..%2fetc%2fx");
  EXPECT_EQ(contentDisposition("a\\b%c;d"),
            "inline; filename=\"a_b_c_d\"; filename*=UTF-8''a%5cb%25c%3bd");
  EXPECT_EQ(contentDisposition(""), "inline; filename=\"_\"; filename*=UTF-8''");
}

// A reply that cannot be written would end the server.
TEST(JsonReply, holdsTextsOfAnyBytes) {
  const HttpReply reply = jsonReply({{"url", "a\xff"}});
  EXPECT_EQ(nlohmann::json::parse(reply.text)["url"], "a\xef\xbf\xbd");
  EXPECT_EQ(reply.type, "application/json");
}

}  // namespace
}  // namespace viewloom::http_reply_test
