// SPDX-License-Identifier: Apache-2.0
#include "web/host_policy.h"

#include <gtest/gtest.h>

namespace viewloom::host_policy_test {
namespace {

const HostPolicy& policy() {
  static const HostPolicy policy({"Render7"}, {"Studio.Example"}, {"https://Show.example"});
  return policy;
}

TEST(HostPolicy, answersToAddressesAndToNamesOfItsOwn) {
  for (const char* host :
       {"localhost", "localhost:80", "page.localhost:80", "127.0.0.1:8080", "127.255.0.3", "[::1]",
        "[::1]:8080", "studio.example:443", "192.168.0.1:8080", "[2001:db8::7]:80", "render7:80"}) {
    EXPECT_TRUE(policy().checkHost(host).ok()) << host;
  }
}

TEST(HostPolicy, answersToNoNameOfOthers) {
  for (const char* host : {"", ":80", "evil.example", "localhost.evil.example", "a.studio.example",
                           "127.0.0.1.evil.example", "192.168.0.1.nip.example", "0x7f000001",
                           "2130706433", "127.1", "[", "]", "[]", "render7.evil.example"}) {
    const absl::Status status = policy().checkHost(host);
    EXPECT_EQ(status.code(), absl::StatusCode::kPermissionDenied) << host;
    EXPECT_EQ(fieldOf(status), "host") << host;
  }
}

absl::Status checkWebSocket(const char* origin) {
  return policy().checkWebSocket({.origin = origin}, "localhost:80");
}

TEST(HostPolicy, letsProgramsAndItsOwnPagesWatch) {
  EXPECT_TRUE(checkWebSocket("").ok());
  EXPECT_TRUE(checkWebSocket("http://LocalHost:80").ok());
  EXPECT_TRUE(checkWebSocket("https://show.example").ok()) << "an allowed page";
  for (const char* origin :
       {"null", "http://evil.example", "http://localhost:81", "http://localhost", "localhost:80",
        "http://", "http://show.example", "https://show.example.evil.example"}) {
    EXPECT_EQ(fieldOf(checkWebSocket(origin)), "origin") << origin;
  }
}

TEST(HostPolicy, listsTheOriginsThatMayFrameThePage) {
  EXPECT_EQ(policy().allowedOrigins(), std::vector<std::string>{"https://show.example"});
  EXPECT_TRUE(HostPolicy({}, {}, {}).allowedOrigins().empty());
}

TEST(HostPolicy, letsNoForeignPageEmbedPictures) {
  for (const char* site : {"", "none", "same-origin"}) {
    EXPECT_TRUE(policy().checkPage({.fetch_site = site}).ok()) << site;
  }
  for (const char* site : {"same-site", "cross-site"}) {
    EXPECT_EQ(fieldOf(policy().checkPage({.fetch_site = site, .fetch_mode = "no-cors"})), "origin");
    PageHeaders moved{.fetch_site = site, .fetch_mode = "navigate", .fetch_dest = "document"};
    EXPECT_TRUE(policy().checkPage(moved).ok()) << "a link";
    for (const char* frame : {"iframe", "frame", "object", "embed"}) {
      moved.fetch_dest = frame;
      EXPECT_EQ(fieldOf(policy().checkPage(moved)), "origin") << frame;
    }
    EXPECT_TRUE(
        policy().checkPage({.referer = "https://show.example/page", .fetch_site = site}).ok());
  }
}

TEST(HostPolicy, knowsWhichAllowedPageAsks) {
  EXPECT_EQ(policy().allowedOrigin({.origin = "https://show.example"}), "https://show.example");
  EXPECT_EQ(policy().allowedOrigin({.referer = "https://SHOW.example/a?b"}),
            "https://show.example");
  EXPECT_EQ(policy().allowedOrigin({.referer = "https://other.example/https://show.example"}), "");
  EXPECT_EQ(policy().allowedOrigin({}), "");
}

TEST(HostPolicy, knowsTheNamesOfThisMachine) {
  for (const std::string& name : machineNames()) {
    EXPECT_TRUE(HostPolicy(machineNames(), {}, {}).checkHost(name + ":8080").ok()) << name;
  }
}

}  // namespace
}  // namespace viewloom::host_policy_test
