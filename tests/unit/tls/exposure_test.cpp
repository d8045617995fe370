// SPDX-License-Identifier: Apache-2.0
#include "tls/exposure.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace viewloom::exposure_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

TEST(Exposure, staysOnTheMachineOnLoopbackAndUnixSockets) {
  const Exposure exposure{.addresses = {"127.0.0.1:50051", "[::1]:8080", "localhost:1",
                                        "unix:/run/viewloom", "127.0.0.9:0"}};
  EXPECT_EQ(reachOf(exposure), ServerReach::kMachine);
  EXPECT_FALSE(refusalToListen(exposure));
}

TEST(Exposure, isProtectedWithTlsAndAccessControlAlone) {
  for (const char* address : {"0.0.0.0:50051", "[::]:8080", "10.0.0.5:1", "studio.local:1"}) {
    Exposure exposure{.addresses = {"127.0.0.1:8080", address}};
    for (const bool has_tls : {false, true}) {
      for (const bool has_access_control : {false, true}) {
        exposure.has_tls = has_tls;
        exposure.has_access_control = has_access_control;
        const bool is_protected = has_tls && has_access_control;
        EXPECT_EQ(reachOf(exposure), is_protected ? ServerReach::kProtected : ServerReach::kOpen)
            << address;
        EXPECT_EQ(refusalToListen(exposure).has_value(), !is_protected) << address;
      }
    }
  }
}

TEST(Exposure, isOpenOnlyWhereSomebodySaysSo) {
  Exposure exposure{.addresses = {"127.0.0.1:50051", "0.0.0.0:8080"}};
  EXPECT_THAT(*refusalToListen(exposure), AllOf(HasSubstr("0.0.0.0:8080 is open"),
                                                HasSubstr("encryption (tls.certificate) and "
                                                          "access control"),
                                                HasSubstr("--open")));
  exposure.has_tls = true;
  EXPECT_THAT(*refusalToListen(exposure),
              AllOf(HasSubstr("without access control;"), Not(HasSubstr("encryption"))));
  exposure.is_open_wanted = true;
  EXPECT_FALSE(refusalToListen(exposure));
  EXPECT_EQ(reachOf(exposure), ServerReach::kOpen);
}

}  // namespace
}  // namespace viewloom::exposure_test
