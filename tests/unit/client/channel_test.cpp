// SPDX-License-Identifier: Apache-2.0
#include "lib/channel.h"

#include <gtest/gtest.h>

namespace viewloom::channel_test {
namespace {

TEST(StaysOnMachine, isTrueOfSocketsAndTheLoopbackAlone) {
  for (const char* address :
       {"127.0.0.1:50051", "127.3.2.1:1", "localhost:50051", "[::1]:50051", "unix:/run/viewloom",
        "unix-abstract:viewloom", "localhost", "https://127.0.0.1:1"}) {
    EXPECT_TRUE(staysOnMachine(address)) << address;
  }
  for (const char* address : {"10.0.0.127:50051", "render.example:50051", "[2001:db8::1]:50051",
                              "localhost.example:1", "0.0.0.0:50051", "https://10.0.0.1:1", ""}) {
    EXPECT_FALSE(staysOnMachine(address)) << address;
  }
}

}  // namespace
}  // namespace viewloom::channel_test
