// SPDX-License-Identifier: Apache-2.0
#include "cli/interrupt.h"

#include <chrono>
#include <condition_variable>
#include <csignal>
#include <cstdio>
#include <mutex>
#include <utility>

namespace viewloom::cli {
namespace {

constexpr std::chrono::milliseconds kLimit{950};

volatile std::sig_atomic_t interrupted = 0;  // the signal

void onSignal(int signal) {
  interrupted = signal;
  std::signal(signal, SIG_DFL);
}

}  // namespace

void surviveFileSizeLimit() {
  std::signal(SIGXFSZ, SIG_IGN);
}

void catchInterrupts() {
  std::signal(SIGINT, onSignal);
  std::signal(SIGTERM, onSignal);
}

bool isInterrupted() {
  return interrupted != 0;
}

InterruptLimit::InterruptLimit(std::function<void()> keep) {
  catchInterrupts();
  thread_ =
      std::jthread([keep = std::move(keep)](const std::stop_token& stop) { run(stop, keep); });
}

void InterruptLimit::run(const std::stop_token& stop, const std::function<void()>& keep) {
  std::mutex mutex;
  std::condition_variable_any stopped;
  std::unique_lock lock(mutex);
  const auto pause = [&](std::chrono::nanoseconds time) {
    stopped.wait_for(lock, stop, time, [] { return false; });
    return !stop.stop_requested();
  };
  while (!isInterrupted()) {
    if (!pause(std::chrono::nanoseconds(kInterruptTick_ns))) return;
  }
  if (!pause(kLimit)) return;
  if (keep) keep();
  std::fprintf(stderr, "viewloom: ended before its work was done\n");
  std::signal(interrupted, SIG_DFL);
  std::raise(interrupted);
}

}  // namespace viewloom::cli
