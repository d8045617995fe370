// SPDX-License-Identifier: Apache-2.0
#include "base/host_port.h"

#include <gtest/gtest.h>

namespace viewloom::test::host_port_test {
namespace {

TEST(HostPort, readsWhatPeopleWrite) {
  struct Case {
    const char* text;
    const char* host;
    std::optional<uint16_t> port;
  };
  for (const Case& given :
       {Case{"localhost", "localhost", {}}, Case{"127.0.0.1:8080", "127.0.0.1", 8080},
        Case{"a.example:0", "a.example", 0}, Case{"[::1]", "::1", {}},
        Case{"[2001:db8::7]:65535", "2001:db8::7", 65535}, Case{"host:", "host", {}}}) {
    const std::optional<HostPort> parsed = parseHostPort(given.text);
    ASSERT_TRUE(parsed) << given.text;
    EXPECT_EQ(parsed->host, given.host);
    EXPECT_EQ(parsed->port, given.port);
  }
}

TEST(HostPort, takesNothingElse) {
  for (const char* text : {"", ":8080", "[]:80", "[::1", "::1", "fe80::1:8080", "host:65536",
                           "host:-1", "host:80x", "host:8 0", "[::1]8080", "a:b:80", "host:+1"}) {
    EXPECT_FALSE(parseHostPort(text)) << text;
  }
}

TEST(HostPort, isWrittenAsItWasRead) {
  for (const char* text : {"localhost", "10.0.0.7:50051", "[::1]", "[2001:db8::7]:80"}) {
    EXPECT_EQ(parseHostPort(text).value().text(), text);
  }
}

TEST(HostPort, knowsTheLoopbackByAddressNotByLook) {
  for (const char* host : {"localhost", "LocalHost", "viewer.localhost", "127.0.0.1", "127.9.8.7",
                           "::1", "0:0:0:0:0:0:0:1", "::ffff:127.0.0.1"}) {
    EXPECT_TRUE(isLoopbackHost(host)) << host;
  }
  for (const char* host : {"", "127.example.org", "127.0.0.1.example.org", "localhost.example.org",
                           "10.0.0.1", "::", "::2", "::ffff:10.0.0.1", "128.0.0.1"}) {
    EXPECT_FALSE(isLoopbackHost(host)) << host;
  }
}

TEST(UrlToOpen, hasAHostThatCanBeOpened) {
  EXPECT_EQ(urlToOpen("http://0.0.0.0:8080/", "localhost"), "http://localhost:8080/");
  EXPECT_EQ(urlToOpen("https://[::]:8080/a/b", "studio.local"), "https://studio.local:8080/a/b");
  EXPECT_EQ(urlToOpen("http://0.0.0.0:8080", "fd00::5"), "http://[fd00::5]:8080");
  for (const char* url : {"http://127.0.0.1:8080/", "http://[::1]:1/", "http://10.0.0.0:1/0.0.0.0",
                          "0.0.0.0:8080", ""}) {
    EXPECT_EQ(urlToOpen(url, "localhost"), url);
  }
}

TEST(IdentityOfHost, isOneForAllAddressesOfAClient) {
  for (const char* const host : {"127.0.0.1", "localhost", "::1", "::ffff:127.0.0.2"}) {
    EXPECT_EQ(identityOfHost(host), "this machine") << host;
  }
  EXPECT_EQ(identityOfHost("this machine"), "this machine");
  EXPECT_EQ(identityOfHost("10.0.0.7"), "10.0.0.7");
  EXPECT_EQ(identityOfHost("::ffff:10.0.0.7"), "10.0.0.7");
  EXPECT_EQ(identityOfHost("2001:db8:0:1:aaaa::1"), "2001:db8:0:1::/64");
  EXPECT_EQ(identityOfHost("2001:db8:0:1::2"), "2001:db8:0:1::/64");
  EXPECT_EQ(identityOfHost("fe80::1%eth0"), identityOfHost("fe80::2"));
  EXPECT_NE(identityOfHost("2001:db8:0:2::2"), identityOfHost("2001:db8:0:1::2"));
}

}  // namespace
}  // namespace viewloom::test::host_port_test
