// SPDX-License-Identifier: Apache-2.0
// Compiles kernels on threads of its own, for frames and pictures that wait for them. However many
// wait for a kernel, it takes one thread, so that others are left for other kernels.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <list>
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
    const void* place;  // as in MissingKernels
    std::function<void()> compile;
    std::vector<OrderPtr> orders;  // empty = nobody waits
  };
  using Kernels = std::list<Kernel>;
  // An order that lacks kernels, and whose caller is told later.
  struct Late {
    OrderPtr order;
    Clock::time_point due;
  };

  void run(const std::stop_token& stop);
  // These six are called under the lock.
  void forgetAll();
  bool waitForWork(std::unique_lock<std::mutex>& lock, const std::stop_token& stop);
  OrderPtr takeLate();
  Kernels& next() { return waiting_.empty() ? ahead_ : waiting_; }
  Kernels::iterator takeNext();
  Kernel* find(const void* place);
  bool compileUnlessOutOfMemory(const Kernel& kernel);
  void compileOne(Kernels::iterator kernel);
  std::vector<OrderPtr> finish(Kernels::iterator kernel, bool is_compiled);
  void tell(const Order& order);

  const std::function<void(const std::exception& error)> on_failure_;
  const std::function<void()> before_each_;
  std::mutex mutex_;  // guards what follows, and the counts of orders
  std::condition_variable_any added_;
  std::condition_variable done_;
  Kernels waiting_;
  Kernels ahead_;
  Kernels begun_;
  std::deque<Late> late_;              // the one that is due first, first
  uint32_t busy_count_ = 0;            // threads that compile or tell
  std::vector<std::jthread> threads_;  // last: they use all of the above
};

}  // namespace viewloom
