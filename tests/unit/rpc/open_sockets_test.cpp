// SPDX-License-Identifier: Apache-2.0
#include "rpc/open_sockets.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>

namespace viewloom::open_sockets_test {
namespace {

std::array<int, 2> makePair() {
  std::array<int, 2> ends{};
  EXPECT_EQ(socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()), 0);
  return ends;
}

TEST(OpenSockets, countsThoseThatAreOpen) {
  const std::array<int, 2> ends = makePair();
  OpenSockets sockets;
  EXPECT_EQ(sockets.count(), 0u);
  for (const int fd : ends) sockets.add(fd, {});
  EXPECT_EQ(sockets.count(), 2u);
  close(ends[0]);
  EXPECT_EQ(sockets.countMax(), 2u);
  EXPECT_EQ(sockets.count(), 1u);
  EXPECT_EQ(sockets.countMax(), 1u);
  close(ends[1]);
  EXPECT_EQ(sockets.count(), 0u);
}

TEST(OpenSockets, isNotMistakenAboutADescriptorThatServesAgain) {
  const std::array<int, 2> ends = makePair();
  OpenSockets sockets;
  sockets.add(ends[0], {});
  close(ends[0]);
  close(ends[1]);
  const std::array<int, 2> others = makePair();
  ASSERT_EQ(others[0], ends[0]) << "the lowest free descriptor is taken";
  EXPECT_EQ(sockets.count(), 0u);
  close(others[0]);
  close(others[1]);
}

TEST(OpenSockets, giveBackTheMemoryOfThoseThatWereClosed) {
  const std::array<int, 2> ends = makePair();
  MemoryBudget budget(1000);
  OpenSockets sockets;
  for (const int fd : ends) {
    sockets.add(fd, *budget.tryReserve({.use = MemoryUse::kConnections, .bytes = 100}));
  }
  EXPECT_EQ(budget.reservedBytes(), 200u);
  close(ends[0]);
  sockets.count();
  EXPECT_EQ(budget.reservedBytes(), 100u);
  close(ends[1]);
}

}  // namespace
}  // namespace viewloom::open_sockets_test
