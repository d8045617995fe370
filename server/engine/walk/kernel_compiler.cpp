// SPDX-License-Identifier: Apache-2.0
#include "walk/kernel_compiler.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "base/log.h"
#include "base/thread_name.h"
#include "gpu/device_error.h"

namespace viewloom {

KernelCompiler::KernelCompiler(uint32_t thread_count,
                               std::function<void(const std::exception& error)> on_failure,
                               std::function<void()> before_each)
    : on_failure_(std::move(on_failure)), before_each_(std::move(before_each)) {
  for (uint32_t i = 0; i < thread_count; ++i) {
    threads_.emplace_back([this](const std::stop_token& stop) {
      nameThread("compile");
      run(stop);
    });
  }
}

KernelCompiler::~KernelCompiler() {
  drain();
}

void KernelCompiler::compile(MissingKernels kernels, std::function<void()> then) {
  const auto order = std::make_shared<Order>(
      Order{.left_count = uint32_t(kernels.size()), .then = std::move(then)});
  std::lock_guard lock(mutex_);
  for (auto& [place, compile] : kernels) {
    if (Kernel* const same = find(place)) {
      same->orders.push_back(order);
    } else {
      waiting_.push_back({place, std::move(compile), {order}});
    }
  }
  added_.notify_all();
}

void KernelCompiler::compileAhead(MissingKernels kernels) {
  std::lock_guard lock(mutex_);
  for (auto& [place, compile] : kernels) ahead_.push_back({place, std::move(compile), {}});
  added_.notify_all();
}

void KernelCompiler::drain() {
  std::unique_lock lock(mutex_);
  forgetAll();
  done_.wait(lock, [this] { return busy_count_ == 0; });
  forgetAll();  // what those that had begun have ordered, or are to be told of later
}

void KernelCompiler::forgetAll() {
  waiting_.clear();
  ahead_.clear();
  late_.clear();
}

void KernelCompiler::run(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (waitForWork(lock, stop)) {
    ++busy_count_;
    if (const OrderPtr late = takeLate()) {
      lock.unlock();
      tell(*late);
    } else {
      const Kernels::iterator kernel = takeNext();
      lock.unlock();
      compileOne(kernel);
    }
    lock.lock();
    --busy_count_;
    done_.notify_all();
  }
}

// False once the compiler ends.
bool KernelCompiler::waitForWork(std::unique_lock<std::mutex>& lock, const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    const auto changes = [this, late_count = late_.size()] {
      return !next().empty() || late_.size() != late_count;
    };
    if (!next().empty()) return true;
    if (late_.empty()) {
      added_.wait(lock, stop, changes);
    } else if (Clock::now() >= late_.front().due) {
      return true;
    } else {
      added_.wait_until(lock, stop, late_.front().due, changes);
    }
  }
  return false;
}

// The order that has waited long enough, if there is one.
KernelCompiler::OrderPtr KernelCompiler::takeLate() {
  if (late_.empty() || Clock::now() < late_.front().due) return nullptr;
  OrderPtr order = std::move(late_.front().order);
  late_.pop_front();
  return order;
}

KernelCompiler::Kernels::iterator KernelCompiler::takeNext() {
  begun_.splice(begun_.end(), next(), next().begin());
  return std::prev(begun_.end());
}

// One that is being compiled, or that somebody waits for; nullptr = it is neither.
KernelCompiler::Kernel* KernelCompiler::find(const void* place) {
  for (Kernels* const kernels : {&begun_, &waiting_}) {
    const auto found = std::ranges::find(*kernels, place, &Kernel::place);
    if (found != kernels->end()) return &*found;
  }
  return nullptr;
}

// False: there was no memory. Whoever waits asks again.
bool KernelCompiler::compileUnlessOutOfMemory(const Kernel& kernel) {
  try {
    before_each_();
    kernel.compile();
    return true;
  } catch (const std::exception& error) {
    if (!isOutOfDeviceMemory(error)) throw;
    log(LogLevel::kWarning, "a kernel is not compiled: ", deviceErrorText(error));
    return false;
  }
}

void KernelCompiler::compileOne(Kernels::iterator kernel) {
  std::vector<OrderPtr> complete;
  try {
    complete = finish(kernel, compileUnlessOutOfMemory(*kernel));
  } catch (const std::exception& error) {
    on_failure_(error);
  }
  for (const OrderPtr& order : complete) tell(*order);
}

// Returns the orders that are to be told now.
std::vector<KernelCompiler::OrderPtr> KernelCompiler::finish(Kernels::iterator kernel,
                                                             bool is_compiled) {
  std::lock_guard lock(mutex_);
  std::vector<OrderPtr> complete;
  for (const OrderPtr& order : kernel->orders) {
    if (!is_compiled) order->lacks_kernels = true;
    if (--order->left_count > 0) continue;
    if (order->lacks_kernels) {
      late_.push_back({order, Clock::now() + kPause});
      added_.notify_all();
    } else {
      complete.push_back(order);
    }
  }
  begun_.erase(kernel);
  return complete;
}

void KernelCompiler::tell(const Order& order) {
  try {
    order.then();
  } catch (const std::exception& error) {
    on_failure_(error);
  }
}

}  // namespace viewloom
