// SPDX-License-Identifier: Apache-2.0
#include "web/host_policy.h"

#include <gtest/gtest.h>

namespace viewloom::host_policy_test {
namespace {

TEST(HostPolicy, answersOnLoopbackOnlyToNamesOfLoopback) {
  const HostPolicy policy(true, {"Studio.Example"});
  for (const char* host : {"localhost", "localhost:80", "page.localhost:80", "127.0.0.1:8080",
                           "127.255.0.3", "[::1]", "[::1]:8080", "studio.example:443"}) {
    EXPECT_TRUE(policy.checkHost(host).ok()) << host;
  }
  for (const char* host : {"", ":80", "evil.example", "localhost.evil.example", "192.168.0.1",
                           "127.0.0.1.evil.example", "[::2]:80", "[", "]", "[]", "0.0.0.0"}) {
    const absl::Status status = policy.checkHost(host);
    EXPECT_EQ(status.code(), absl::StatusCode::kPermissionDenied) << host;
    EXPECT_EQ(fieldOf(status), "host") << host;
  }
}

TEST(HostPolicy, answersToAnyNameElsewhere) {
  EXPECT_TRUE(HostPolicy(false, {}).checkHost("studio.example").ok());
}

TEST(HostPolicy, letsProgramsAndItsOwnPagesWatch) {
  for (const bool loopback : {false, true}) {
    const HostPolicy policy(loopback, {});
    EXPECT_TRUE(policy.checkOrigin("", "localhost:80").ok());
    EXPECT_TRUE(policy.checkOrigin("http://LocalHost:80", "localhost:80").ok());
    for (const char* origin : {"null", "http://evil.example", "http://localhost:81",
                               "http://localhost", "localhost:80", "http://"}) {
      EXPECT_EQ(fieldOf(policy.checkOrigin(origin, "localhost:80")), "origin") << origin;
    }
  }
}

}  // namespace
}  // namespace viewloom::host_policy_test
