// SPDX-License-Identifier: Apache-2.0
#include "base/payer.h"

#include <gtest/gtest.h>

namespace viewloom::payer_test {
namespace {

TEST(Payer, isTheClientAtAnAddress) {
  EXPECT_EQ(Payer::ofHost("10.0.0.7").name(), "10.0.0.7");
  EXPECT_EQ(Payer::ofHost("10.0.0.7"), Payer::ofHost("::ffff:10.0.0.7"));
  EXPECT_NE(Payer::ofHost("10.0.0.7"), Payer::ofHost("10.0.0.8"));
  EXPECT_EQ(Payer::ofHost("2001:db8:1:2:3:4:5:6"), Payer::ofHost("2001:db8:1:2::1"));
}

TEST(Payer, isAClientOrTheServer) {
  EXPECT_TRUE(Payer().isServer());
  EXPECT_FALSE(Payer("camera-1").isServer());
  EXPECT_EQ(Payer("camera-1").name(), "camera-1");
}

TEST(Payer, tellsClientsOnThisMachineFromOthers) {
  for (const char* host : {"127.0.0.2", "::1", "::ffff:127.0.0.1", "localhost"}) {
    EXPECT_TRUE(Payer::ofHost(host).isLocal()) << host;
  }
  EXPECT_FALSE(Payer::ofHost("10.0.0.7").isLocal());
  EXPECT_FALSE(Payer("camera-1").isLocal());
  EXPECT_FALSE(Payer().isLocal());
}

}  // namespace
}  // namespace viewloom::payer_test
