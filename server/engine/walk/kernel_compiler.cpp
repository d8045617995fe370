// SPDX-License-Identifier: Apache-2.0
#include "walk/kernel_compiler.h"

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
  const auto order = std::make_shared<Order>(Order{uint32_t(kernels.size()), std::move(then)});
  std::lock_guard lock(mutex_);
  for (auto& [place, kernel] : kernels) waiting_.push_back({std::move(kernel), order});
  added_.notify_all();
}

void KernelCompiler::compileAhead(MissingKernels kernels) {
  std::lock_guard lock(mutex_);
  for (auto& [place, kernel] : kernels) ahead_.push_back({std::move(kernel), nullptr});
  added_.notify_all();
}

void KernelCompiler::drain() {
  std::unique_lock lock(mutex_);
  waiting_.clear();
  ahead_.clear();
  done_.wait(lock, [this] { return begun_count_ == 0; });
}

void KernelCompiler::run(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (added_.wait(lock, stop, [this] { return !next().empty(); })) {
    const Kernel kernel = std::move(next().front());
    next().pop_front();
    ++begun_count_;
    lock.unlock();
    compileOne(kernel);
    lock.lock();
    --begun_count_;
    done_.notify_all();
  }
}

// Whoever waits asks again for a kernel for which there was no memory.
void KernelCompiler::compileUnlessOutOfMemory(const Kernel& kernel) {
  try {
    before_each_();
    kernel.compile();
  } catch (const std::exception& error) {
    if (!isOutOfDeviceMemory(error)) throw;
    log(LogLevel::kWarning, "a kernel is not compiled: ", deviceErrorText(error));
  }
}

void KernelCompiler::compileOne(const Kernel& kernel) {
  try {
    compileUnlessOutOfMemory(kernel);
    if (kernel.order == nullptr) return;
    bool is_last = false;
    {
      std::lock_guard lock(mutex_);
      is_last = --kernel.order->left_count == 0;
    }
    if (is_last) kernel.order->then();
  } catch (const std::exception& error) {
    on_failure_(error);
  }
}

}  // namespace viewloom
