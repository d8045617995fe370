// SPDX-License-Identifier: Apache-2.0
#include "web/routes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace viewloom::routes_test {

using testing::Contains;
using testing::Pair;

HttpReply redirectOf(const std::string& target) {
  return redirectToTls({.target = target, .host = "studio:8080"});
}

TEST(RedirectToTls, keepsTheAddress) {
  const HttpReply reply = redirectOf("/api/streams?x=1");
  EXPECT_EQ(reply.status, 302U);
  EXPECT_THAT(reply.headers, Contains(Pair("Location", "https://studio:8080/api/streams?x=1")));
}

// "studio:8080" and "@evil.example/" together name the host evil.example.
TEST(RedirectToTls, refusesTargetsThatAreNoPath) {
  for (const char* target :
       {"@evil.example/", ".evil.example/", "http://evil.example/", "1/", "*", ""}) {
    const HttpReply reply = redirectOf(target);
    EXPECT_EQ(reply.status, 400U) << target;
    EXPECT_THAT(reply.text, testing::HasSubstr("accepted is a path that begins with /")) << target;
  }
}

}  // namespace viewloom::routes_test
