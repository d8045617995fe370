// SPDX-License-Identifier: Apache-2.0
// Compiles kernels on threads of its own, for frames and pictures that wait for them.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "gpu/pass_map.h"

namespace viewloom {

// Thread-safety: all methods may be called from any thread.
class KernelCompiler {
 public:
  // `on_failure` is called on one of its threads when a kernel cannot be compiled; nothing more is
  // compiled for whoever needs that kernel. `before_each`: for tests.
  KernelCompiler(
      uint32_t thread_count, std::function<void(const std::exception& error)> on_failure,
      std::function<void()> before_each = [] {});
  // The same as drain().
  ~KernelCompiler();

  // `then` is called on one of its threads once all of these are compiled, or have been tried.
  // Where there was no device memory for some, that is kPause later: whoever asks again then gives
  // others time to leave some.
  void compile(MissingKernels kernels, std::function<void()> then);
  // Compiles these while nobody waits for others, in the order of the calls.
  void compileAhead(MissingKernels kernels);
  // Forgets kernels that have not begun, and waits for the others. Then nobody is told any more.
  void drain();

  static constexpr std::chrono::milliseconds kPause{250};

 private:
  using Clock = std::chrono::steady_clock;

  // The kernels that one caller waits for.
  struct Order {
    uint32_t left_count = 0;
    bool lacks_kernels = false;  // there was no memory for some
    std::function<void()> then;
  };
  using OrderPtr = std::shared_ptr<Order>;
  struct Kernel {
    std::function<void()> compile;
    OrderPtr order;  // nullptr = nobody waits
  };
  // An order that lacks kernels, and whose caller is told later.
  struct Late {
    OrderPtr order;
    Clock::time_point due;
  };

  void run(const std::stop_token& stop);
  // These four are called under the lock.
  void forgetAll();
  bool waitForWork(std::unique_lock<std::mutex>& lock, const std::stop_token& stop);
  OrderPtr takeLate();
  std::deque<Kernel>& next() { return waiting_.empty() ? ahead_ : waiting_; }
  bool compileUnlessOutOfMemory(const Kernel& kernel);
  void compileOne(const Kernel& kernel);
  void tell(const Order& order);

  const std::function<void(const std::exception& error)> on_failure_;
  const std::function<void()> before_each_;
  std::mutex mutex_;  // guards what follows, and the counts of orders
  std::condition_variable_any added_;
  std::condition_variable done_;
  std::deque<Kernel> waiting_;
  std::deque<Kernel> ahead_;
  std::deque<Late> late_;  // the one that is due first, first
  uint32_t begun_count_ = 0;
  std::vector<std::jthread> threads_;  // last: they use all of the above
};

}  // namespace viewloom
