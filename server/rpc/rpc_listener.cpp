// SPDX-License-Identifier: Apache-2.0
#include "rpc/rpc_listener.h"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>
#include <utility>

#include "admission/display_price.h"
#include "admission/request_boundary.h"
#include "base/host_port.h"
#include "base/send_queue.h"
#include "base/str_cat.h"
#include "base/thread_name.h"
#include "rpc/listening_sockets.h"
#include "rpc/peer_host.h"

namespace viewloom {
namespace {

// Until the next attempt to accept, when the process has no free descriptor.
constexpr std::chrono::milliseconds kAcceptPause{50};
// Between two counts while the port or the share of a client is full. A flood then costs little for
// each connection, and never fills the system's queue, in which others would wait.
constexpr std::chrono::milliseconds kCountPause{20};

// Fails harmlessly for UNIX sockets.
void setConnectionOptions(int fd, std::chrono::milliseconds acknowledge_time) {
  const int on = 1;
  const auto limit_ms = static_cast<int>(acknowledge_time.count());
  setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  setsockopt(fd, IPPROTO_TCP, TCP_USER_TIMEOUT, &limit_ms, sizeof limit_ms);
  limitSendQueue(fd);
}

}  // namespace

RpcListener::RpcListener(const RpcListenerOptions& options, const Metrics& metrics,
                         MemoryBudget& memory)
    : options_(options), metrics_(metrics), memory_(memory) {
  ListeningSockets sockets = openListeningSockets(options.address);
  if (sockets.fds.empty()) {
    throw std::runtime_error(
        "cannot listen on " + options.address +
        " for gRPC: another program has the port, or the address is not of this "
        "machine; choose another with --grpc.address");
  }
  listener_fds_ = std::move(sockets.fds);
  port_ = sockets.port;
  wake_fd_ = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
}

RpcListener::~RpcListener() {
  stop();
  close(wake_fd_);
}

void RpcListener::start(HandOver hand_over) {
  hand_over_ = std::move(hand_over);
  thread_ = std::jthread([this](const std::stop_token& stop) {
    nameThread("rpc accept");
    run(stop);
  });
}

void RpcListener::stop() {
  if (thread_.joinable()) {
    thread_.request_stop();
    eventfd_write(wake_fd_, 1);
    thread_.join();
  }
  closeListeningSockets(options_.address, std::exchange(listener_fds_, {}));
}

size_t RpcListener::connectionCount() const {
  std::lock_guard lock(mutex_);
  return connections_.count();
}

absl::Status RpcListener::status() const {
  if (lacks_descriptors_) {
    return absl::ResourceExhaustedError("the server has no free file descriptor");
  }
  std::lock_guard lock(mutex_);
  if (!isFull()) return absl::OkStatus();
  return absl::ResourceExhaustedError(strCat("all ", options_.connection_count_max,
                                             " connections are taken (grpc.connections_max)"));
}

bool RpcListener::isFull() const {
  if (connections_.countMax() < options_.connection_count_max) return false;
  forgetClosed();
  return connections_.countMax() >= options_.connection_count_max;
}

void RpcListener::forgetClosed() const {
  const auto now = std::chrono::steady_clock::now();
  if (now - counted_ < kCountPause) return;
  counted_ = now;
  connections_.count();
}

std::optional<Reservation> RpcListener::reserve(int fd) {
  const MemoryRequest request{.use = MemoryUse::kConnections,
                              .identity = identityOfHost(peerHost(fd)),
                              .bytes = kConnectionBytes};
  if (memory_.leftFor(request.identity) < request.bytes) {
    std::lock_guard lock(mutex_);
    forgetClosed();
  }
  return memory_.tryReserve(request);
}

void RpcListener::run(const std::stop_token& stop) {
  std::vector<pollfd> waits{{.fd = wake_fd_, .events = POLLIN, .revents = 0}};
  for (const int fd : listener_fds_) waits.push_back({.fd = fd, .events = POLLIN, .revents = 0});
  while (!stop.stop_requested()) {
    if (lacks_descriptors_) {
      poll(waits.data(), 1, static_cast<int>(kAcceptPause.count()));  // the wake-up alone
    } else {
      poll(waits.data(), waits.size(), -1);
    }
    if (stop.stop_requested()) return;
    for (const int fd : listener_fds_) acceptFrom(fd);
  }
}

void RpcListener::acceptFrom(int listener_fd) {
  for (;;) {
    const int fd = accept4(listener_fd, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (fd >= 0) {
      lacks_descriptors_ = false;
      takeOrClose(listener_fd, fd);
      continue;
    }
    if (errno == EINTR || errno == ECONNABORTED) continue;
    // Anything else but an empty queue is a lack of descriptors or memory, which passes.
    lacks_descriptors_ = errno != EAGAIN && errno != EWOULDBLOCK;
    return;
  }
}

void RpcListener::takeOrClose(int listener_fd, int fd) {
  try {
    take(listener_fd, fd);
  } catch (const std::exception& thrown) {
    noteThrown("accepting a gRPC connection", thrown);
    close(fd);
  }
}

void RpcListener::take(int listener_fd, int fd) {
  // Before the lock: idle memory is given up for it.
  std::optional<Reservation> memory = reserve(fd);
  std::unique_lock lock(mutex_);
  if (!memory || isFull()) {
    lock.unlock();
    metrics_.connections_refused[Transport::kGrpc].add();
    close(fd);
    return;
  }
  connections_.add(fd, *std::move(memory));
  lock.unlock();
  setConnectionOptions(fd, options_.acknowledge_time);
  hand_over_(listener_fd, fd);
}

}  // namespace viewloom
