// SPDX-License-Identifier: Apache-2.0
#include "cli/page_address.h"

#include <gtest/gtest.h>

namespace viewloom::cli::page_address_test {
namespace {

TEST(PageAddress, isAtTheHostByWhichTheServerWasReached) {
  for (const char* url : {"http://0.0.0.0:8080/", "http://[::]:8080/"}) {
    EXPECT_EQ(pageToOpen(url, "127.0.0.1:50051"), "http://127.0.0.1:8080/");
    EXPECT_EQ(pageToOpen(url, "studio.local:50051"), "http://studio.local:8080/");
    EXPECT_EQ(pageToOpen(url, "studio.local"), "http://studio.local:8080/");
    EXPECT_EQ(pageToOpen(url, "dns:///studio.local:50051"), "http://studio.local:8080/");
    EXPECT_EQ(pageToOpen(url, "[fd00::5]:50051"), "http://[fd00::5]:8080/");
    EXPECT_EQ(pageToOpen(url, "unix:/run/viewloom"), "http://localhost:8080/");
    EXPECT_EQ(pageToOpen(url, "0.0.0.0:50051"), "http://localhost:8080/");
  }
  EXPECT_EQ(pageToOpen("https://0.0.0.0:8080/", "https://studio.example:50051"),
            "https://studio.example:8080/");
}

TEST(PageAddress, staysWhereThePageListensOnOneAddress) {
  for (const char* url :
       {"http://127.0.0.1:8080/", "https://10.0.0.5:1/", "http://[fd00::5]:1/", ""})
    EXPECT_EQ(pageToOpen(url, "studio.local:50051"), url);
}

TEST(PageAddress, saysWhereALoopbackPageCanBeOpened) {
  EXPECT_EQ(pageRemark("http://127.0.0.1:8080/", "studio.local:50051"),
            " (on the server's own machine)");
  EXPECT_EQ(pageRemark("http://127.0.0.1:8080/", "localhost:50051"), "");
  EXPECT_EQ(pageRemark("http://127.0.0.1:8080/", "unix:/run/viewloom"), "");
  EXPECT_EQ(pageRemark("http://studio.local:8080/", "studio.local:50051"), "");
  EXPECT_EQ(pageRemark("", "studio.local:50051"), "");
}

}  // namespace
}  // namespace viewloom::cli::page_address_test
