// SPDX-License-Identifier: Apache-2.0
#include "rpc/rpc_listener.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "admission/display_price.h"
#include "rpc/listening_sockets.h"
#include "support/loopback.h"

namespace viewloom::rpc_listener_test {
namespace {

using namespace std::chrono_literals;

// Waits for something that happens soon on another thread.
template <typename Condition>
bool soon(const Condition& condition) {
  for (int i = 0; i < 500; ++i) {
    if (condition()) return true;
    std::this_thread::sleep_for(10ms);
  }
  return false;
}

// A listener that keeps the connections it accepts.
class KeepingListener {
 public:
  explicit KeepingListener(uint32_t connection_count_max, MemoryBudget& memory = unboundedMemory())
      : listener_({.address = "127.0.0.1:0", .connection_count_max = connection_count_max},
                  metrics_, memory) {
    listener_.start([this](int, int fd) {
      std::lock_guard lock(mutex_);
      fds_.push_back(fd);
    });
  }
  ~KeepingListener() {
    listener_.stop();
    closeAll();
  }

  void closeAll() {
    std::lock_guard lock(mutex_);
    for (const int fd : fds_) close(fd);
    fds_.clear();
  }
  size_t acceptedCount() {
    std::lock_guard lock(mutex_);
    return fds_.size();
  }
  double refusedCount() const { return metrics_.connections_refused[Transport::kGrpc].value(); }
  RpcListener& listener() { return listener_; }

 private:
  Metrics metrics_;
  std::mutex mutex_;
  std::vector<int> fds_;
  RpcListener listener_;
};

// Connects, and closes at its end. Works without a free descriptor: the socket is made before.
class Client {
 public:
  Client() : fd_(socket(AF_INET, SOCK_STREAM, 0)) {}
  ~Client() { close(fd_); }
  bool connectTo(uint16_t port) const { return test::connectTo(fd_, port); }
  // Whether the other end has closed the connection, within a second.
  bool isClosed() const {
    const timeval limit{.tv_sec = 1, .tv_usec = 0};
    setsockopt(fd_, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
    char byte = 0;
    return recv(fd_, &byte, 1, 0) == 0 || errno == ECONNRESET;
  }

 private:
  int fd_;
};

TEST(RpcListener, closesConnectionsBeyondItsLimitAndTakesOthersLater) {
  KeepingListener keeping(2);
  const uint16_t port = keeping.listener().port();
  const Client first;
  const Client second;
  ASSERT_TRUE(first.connectTo(port) && second.connectTo(port));
  ASSERT_TRUE(soon([&] { return keeping.acceptedCount() == 2; }));
  EXPECT_EQ(keeping.listener().status().code(), absl::StatusCode::kResourceExhausted);

  const Client third;
  ASSERT_TRUE(third.connectTo(port));
  EXPECT_TRUE(third.isClosed());
  EXPECT_EQ(keeping.refusedCount(), 1);
  EXPECT_EQ(keeping.acceptedCount(), 2u);

  keeping.closeAll();
  EXPECT_TRUE(soon([&] { return keeping.listener().status().ok(); }));
  const Client fourth;
  ASSERT_TRUE(fourth.connectTo(port));
  EXPECT_TRUE(soon([&] { return keeping.acceptedCount() == 1; }));
  EXPECT_EQ(keeping.listener().connectionCount(), 1u);
}

TEST(RpcListener, closesConnectionsBeyondTheirClientsShareOfMemory) {
  constexpr size_t kFitting = 8;
  MemoryBudget budget(kFitting * kConnectionBytes);
  KeepingListener keeping(100, budget);
  const uint16_t port = keeping.listener().port();
  std::vector<std::unique_ptr<Client>> clients;
  while (clients.size() < kFitting) {
    clients.push_back(std::make_unique<Client>());
    ASSERT_TRUE(clients.back()->connectTo(port));
  }
  EXPECT_TRUE(clients.back()->isClosed());
  EXPECT_EQ(keeping.acceptedCount(), kFitting * 3 / 4);
  EXPECT_EQ(budget.reservedBytes(MemoryUse::kConnections), kFitting * 3 / 4 * kConnectionBytes);
  EXPECT_EQ(keeping.refusedCount(), kFitting / 4);

  keeping.closeAll();
  std::this_thread::sleep_for(50ms);  // closed connections are looked for again
  const Client later;
  ASSERT_TRUE(later.connectTo(port));
  EXPECT_TRUE(soon([&] { return keeping.acceptedCount() == 1; }));
  EXPECT_EQ(budget.reservedBytes(MemoryUse::kConnections), kConnectionBytes);
}

TEST(RpcListener, goesOnAfterThereWasNoDescriptor) {
  KeepingListener keeping(100);
  const Client client;
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &before), 0);
  rlimit none = before;
  none.rlim_cur = 3;
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &none), 0);
  ASSERT_TRUE(client.connectTo(keeping.listener().port()));
  EXPECT_TRUE(soon([&] { return !keeping.listener().status().ok(); }));
  EXPECT_EQ(keeping.acceptedCount(), 0u);
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &before), 0);
  EXPECT_TRUE(soon([&] { return keeping.acceptedCount() == 1; }));
  EXPECT_TRUE(keeping.listener().status().ok());
}

TEST(RpcListener, closesAConnectionThatNobodyCanTakeAndGoesOn) {
  const Metrics metrics;
  RpcListener listener({.address = "127.0.0.1:0", .connection_count_max = 10}, metrics,
                       unboundedMemory());
  listener.start([](int, int) { throw std::runtime_error("planted"); });
  for (int i = 0; i < 2; ++i) {
    const Client client;
    ASSERT_TRUE(client.connectTo(listener.port()));
    EXPECT_TRUE(client.isClosed());
  }
}

TEST(RpcListener, saysWhichAddressCannotBeHad) {
  KeepingListener keeping(1);
  const Metrics metrics;
  const std::string taken = "127.0.0.1:" + std::to_string(keeping.listener().port());
  for (const std::string& address : {taken, std::string("192.0.2.1:0"), std::string("nowhere")}) {
    try {
      const RpcListener second({.address = address}, metrics, unboundedMemory());
      ADD_FAILURE() << address;
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find("cannot listen on " + address), std::string::npos);
    }
  }
}

TEST(ListeningSockets, takeTheSamePortOnAllAddressesOfAHost) {
  const ListeningSockets sockets = openListeningSockets("localhost:0");
  EXPECT_GE(sockets.fds.size(), 1u);
  EXPECT_GT(sockets.port, 0);
  closeListeningSockets("localhost:0", sockets.fds);
}

TEST(ListeningSockets, replaceASocketAndNoOtherFile) {
  const std::string path = testing::TempDir() + "viewloom-listener-" + std::to_string(getpid());
  std::filesystem::remove(path);
  const std::string address = "unix:" + path;
  const ListeningSockets first = openListeningSockets(address);
  const ListeningSockets second = openListeningSockets(address);
  ASSERT_EQ(second.fds.size(), 1u);
  closeListeningSockets(address, first.fds);
  closeListeningSockets(address, second.fds);
  EXPECT_FALSE(std::filesystem::exists(path));
  std::ofstream(path) << "mine";
  EXPECT_TRUE(openListeningSockets(address).fds.empty());
  EXPECT_TRUE(std::filesystem::is_regular_file(path));
  std::filesystem::remove(path);
  EXPECT_TRUE(openListeningSockets("unix:" + std::string(200, 'x')).fds.empty());
}

}  // namespace
}  // namespace viewloom::rpc_listener_test
