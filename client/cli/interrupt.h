// SPDX-License-Identifier: Apache-2.0
// Ctrl-C and SIGTERM as a flag, so that calls end in order.
#pragma once

#include <cstdint>
#include <functional>
#include <stop_token>
#include <thread>

namespace viewloom::cli {

// How long a command that watches may wait before it asks for the flag again.
inline constexpr int64_t kInterruptTick_ns = 50'000'000;

// A file that reaches the largest size allowed is a failed write, not the end of the command.
void surviveFileSizeLimit();

// From now on the first signal raises the flag; the second ends the process at once. Commands call
// this when something begins that has to end in order. Until then a signal ends the process, so
// nothing keeps it waiting: no file that is read, no server that hangs.
void catchInterrupts();
bool isInterrupted();

// Catches interrupts, and ends the process by the signal if it still lives 0.95 s later. Some work
// cannot be broken off: a file on a slow disk, a picture that is packed, a window system that does
// not answer. Thread-safety: one owner.
class InterruptLimit {
 public:
  // `keep` saves what can be saved, on a thread of its own, before the process ends.
  explicit InterruptLimit(std::function<void()> keep = {});
  InterruptLimit(const InterruptLimit&) = delete;
  InterruptLimit& operator=(const InterruptLimit&) = delete;

 private:
  static void run(const std::stop_token& stop, const std::function<void()>& keep);

  std::jthread thread_;
};

}  // namespace viewloom::cli
