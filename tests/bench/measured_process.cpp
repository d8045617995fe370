// SPDX-License-Identifier: Apache-2.0
#include "bench/measured_process.h"

#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>

namespace viewloom::bench {
namespace {

constexpr size_t kAddressBytesMax = 256;

double secondsOf(const timeval& time) {
  return double(time.tv_sec) + 1e-6 * double(time.tv_usec);
}

// Answers every byte with the CPU time, until the other end is closed.
[[noreturn]] void answer(int socket, const std::function<MeasuredProcess::Running()>& begin) {
  try {
    const MeasuredProcess::Running running = begin();
    std::array<char, kAddressBytesMax> address{};
    running.address.copy(address.data(), address.size() - 1);
    if (write(socket, address.data(), address.size()) < 0) std::_Exit(1);
    for (char asked = 0; read(socket, &asked, 1) == 1;) {
      const double time_s = cpuTime_s();
      if (write(socket, &time_s, sizeof time_s) < 0) break;
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "viewloom-bench: %s\n", error.what());
    std::_Exit(1);
  }
  std::_Exit(0);
}

}  // namespace

double cpuTime_s() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return secondsOf(usage.ru_utime) + secondsOf(usage.ru_stime);
}

MeasuredProcess::MeasuredProcess(const std::function<Running()>& begin) {
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    throw std::runtime_error("cannot make a pair of sockets");
  }
  child_ = fork();
  if (child_ < 0) throw std::runtime_error("cannot fork");
  if (child_ == 0) {
    close(ends[0]);
    answer(ends[1], begin);
  }
  close(ends[1]);
  socket_ = ends[0];
  std::array<char, kAddressBytesMax> address{};
  if (recv(socket_, address.data(), address.size(), MSG_WAITALL) != ssize_t(address.size())) {
    throw std::runtime_error("a process of the benchmark has ended");
  }
  address_ = address.data();
}

MeasuredProcess::~MeasuredProcess() {
  close(socket_);
  waitpid(child_, nullptr, 0);
}

double MeasuredProcess::cpuTime_s() const {
  const char asked = 1;
  double time_s = 0;
  if (write(socket_, &asked, 1) != 1 ||
      recv(socket_, &time_s, sizeof time_s, MSG_WAITALL) != ssize_t(sizeof time_s)) {
    throw std::runtime_error("a process of the benchmark has ended");
  }
  return time_s;
}

}  // namespace viewloom::bench
