// SPDX-License-Identifier: Apache-2.0
#include "web/text_replies.h"

#include <gtest/gtest.h>

namespace viewloom::text_replies_test {
namespace {

TEST(TextReplies, giveTheNewestOfEachKindRefusalsFirst) {
  TextReplies replies;
  EXPECT_EQ(replies.take(0), std::nullopt);
  replies.clock(1, 2);
  replies.pong(3);
  replies.pong(4);
  replies.clock(INT64_MAX, 6);
  replies.error(R"({"error": {}})");
  EXPECT_EQ(replies.take(7), R"({"error": {}})");
  EXPECT_EQ(replies.take(7), R"({"pong":4})");
  EXPECT_EQ(nlohmann::json::parse(replies.take(7).value()),
            nlohmann::json::parse(R"({"clock": {"client_time_ns": "9223372036854775807",
                "server_received_ns": "6", "server_sent_ns": "7"}})"));
  EXPECT_EQ(replies.take(8), std::nullopt);
}

}  // namespace
}  // namespace viewloom::text_replies_test
