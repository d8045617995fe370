// SPDX-License-Identifier: Apache-2.0
#include "certificates/server_address.h"

#include <gtest/gtest.h>

namespace viewloom::server_address_test {
namespace {

TEST(ServerAddress, tellsTlsByItsScheme) {
  const ServerAddress address = parseServerAddress("https://studio.local:50051");
  EXPECT_TRUE(address.has_tls);
  EXPECT_EQ(address.target, "studio.local:50051");
  EXPECT_EQ(address.text(), "https://studio.local:50051");
  EXPECT_EQ(parseServerAddress("https://[::1]:443/").target, "[::1]:443");
}

TEST(ServerAddress, takesOthersForUnencrypted) {
  for (const char* text : {"127.0.0.1:50051", "unix:/run/viewloom", "localhost", ""}) {
    const ServerAddress address = parseServerAddress(text);
    EXPECT_FALSE(address.has_tls);
    EXPECT_EQ(address.target, text);
    EXPECT_EQ(address.text(), text);
  }
}

}  // namespace
}  // namespace viewloom::server_address_test
