// SPDX-License-Identifier: Apache-2.0
#include "rpc/peer_host.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>

namespace viewloom::peer_host_test {
namespace {

TEST(PeerHost, isTheAddressWithoutThePort) {
  EXPECT_EQ(peerHost("ipv4:10.0.0.7:4711"), "10.0.0.7");
  EXPECT_EQ(peerHost("ipv6:[2001:db8::1]:4711"), "2001:db8::1");
  EXPECT_EQ(peerHost("ipv6:%5B2001:db8::1%5D:4711"), "2001:db8::1");
}

TEST(PeerHost, isOneForAllWaysToAMachine) {
  EXPECT_EQ(peerHost("ipv6:[::ffff:10.0.0.7]:4711"), "10.0.0.7");
  for (const char* peer : {"ipv4:127.0.0.1:1", "ipv4:127.0.1.1:1", "ipv6:[::1]:1",
                           "ipv6:%5B::ffff:127.0.0.1%5D:1", "unix:", "unix:/run/viewloom"}) {
    EXPECT_EQ(peerHost(peer), "this machine") << peer;
  }
}

TEST(PeerHost, isThisMachineForSocketsWithoutAnAddress) {
  std::array<int, 2> ends{};
  ASSERT_EQ(socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()), 0);
  EXPECT_EQ(peerHost(ends[0]), "this machine");
  for (const int fd : ends) close(fd);
}

}  // namespace
}  // namespace viewloom::peer_host_test
