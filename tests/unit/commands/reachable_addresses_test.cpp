// SPDX-License-Identifier: Apache-2.0
#include "commands/reachable_addresses.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace viewloom::reachable_addresses_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

const InterfaceAddresses kInterfaces{.ipv4 = {"192.168.1.5", "10.0.0.7"}, .ipv6 = {"[fd00::5]"}};

TEST(ReachableAddresses, areThoseOfAllInterfacesForAServerThatTakesAny) {
  EXPECT_THAT(reachableAddresses("0.0.0.0:50051", kInterfaces),
              ElementsAre("192.168.1.5:50051", "10.0.0.7:50051"));
  EXPECT_THAT(reachableAddresses("[::]:8080", kInterfaces),
              ElementsAre("192.168.1.5:8080", "10.0.0.7:8080", "[fd00::5]:8080"));
}

TEST(ReachableAddresses, isTheOneThatAServerTakes) {
  EXPECT_THAT(reachableAddresses("192.168.1.5:1", kInterfaces), ElementsAre("192.168.1.5:1"));
  EXPECT_THAT(reachableAddresses("[fd00::5]:1", kInterfaces), ElementsAre("[fd00::5]:1"));
}

TEST(ReachableAddresses, areNoneOfAServerOfThisMachineAlone) {
  for (const char* listening :
       {"127.0.0.1:1", "127.8.8.8:1", "[::1]:1", "localhost:1", "unix:/run/viewloom"}) {
    EXPECT_THAT(reachableAddresses(listening, kInterfaces), IsEmpty()) << listening;
  }
}

TEST(ReachableAddresses, ofThisMachineAreNeitherLoopbackNorLinkLocal) {
  const InterfaceAddresses found = interfaceAddresses();
  for (const std::string& address : found.ipv4) {
    EXPECT_FALSE(address.starts_with("127.") || address.starts_with("169.254.")) << address;
  }
  for (const std::string& address : found.ipv6) {
    EXPECT_FALSE(address == "[::1]" || address.starts_with("[fe80")) << address;
  }
}

}  // namespace
}  // namespace viewloom::reachable_addresses_test
