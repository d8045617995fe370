// SPDX-License-Identifier: Apache-2.0
#include "base/payer.h"

#include <gtest/gtest.h>

#include "base/host_port.h"

namespace viewloom::payer_test {
namespace {

TEST(Payer, isAClientOrTheServer) {
  EXPECT_TRUE(Payer().isServer());
  EXPECT_FALSE(Payer("camera-1").isServer());
  EXPECT_EQ(Payer("camera-1").name(), "camera-1");
}

TEST(Payer, tellsClientsOnThisMachineFromOthers) {
  for (const char* host : {"127.0.0.2", "::1", "::ffff:127.0.0.1", "localhost"}) {
    EXPECT_TRUE(Payer(identityOfHost(host)).isLocal()) << host;
  }
  EXPECT_FALSE(Payer(identityOfHost("10.0.0.7")).isLocal());
  EXPECT_FALSE(Payer("camera-1").isLocal());
  EXPECT_FALSE(Payer().isLocal());
}

}  // namespace
}  // namespace viewloom::payer_test
