// SPDX-License-Identifier: Apache-2.0
// In which order kernels are compiled, and whom that tells. No device is needed.
#include "walk/kernel_compiler.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <future>
#include <mutex>
#include <new>
#include <string>
#include <thread>
#include <vector>

namespace viewloom::kernel_compiler_test {
namespace {

using testing::ElementsAre;

class KernelCompilerTest : public testing::Test {
 protected:
  // A kernel that writes its name down.
  MissingKernels kernelOf(const std::string& name) {
    MissingKernels kernels;
    kernels.emplace(&places_[next_place_++], [this, name] {
      std::lock_guard lock(mutex_);
      compiled_.push_back(name);
    });
    return kernels;
  }
  std::vector<std::string> compiled() {
    std::lock_guard lock(mutex_);
    return compiled_;
  }
  // Keeps the one thread of the compiler until the result is set.
  std::promise<void> hold(KernelCompiler& compiler) {
    std::promise<void> begun;
    std::promise<void> release;
    MissingKernels kernels;
    kernels.emplace(&places_[next_place_++], [&begun, held = release.get_future().share()] {
      begun.set_value();
      held.wait();
    });
    compiler.compile(std::move(kernels), [] {});
    begun.get_future().wait();
    return release;
  }
  // A kernel that everybody shares; compiling it waits for `hold`.
  MissingKernels sharedKernel(const std::shared_future<void>& hold, std::atomic<int>& begun_count) {
    MissingKernels kernels;
    kernels.emplace(&shared_place_, [hold, &begun_count] {
      ++begun_count;
      hold.wait();
    });
    return kernels;
  }
  // Asks again each time it is told, as frames and pictures do, for a kernel that never has memory.
  void askAgain(KernelCompiler& compiler) {
    ++asked_count_;
    MissingKernels kernels;
    kernels.emplace(&shared_place_, [] { throw std::bad_alloc(); });
    compiler.compile(std::move(kernels), [this, &compiler] { askAgain(compiler); });
  }
  int askedCount() const { return asked_count_; }
  static void failTest(const std::exception& error) { ADD_FAILURE() << error.what(); }

 private:
  std::atomic<int> asked_count_ = 0;
  char places_[16] = {};
  char shared_place_ = 0;
  size_t next_place_ = 0;
  std::mutex mutex_;
  std::vector<std::string> compiled_;
};

TEST_F(KernelCompilerTest, compilesWhatSomebodyWaitsForBeforeWhatMayBeNeeded) {
  KernelCompiler compiler(1, failTest);
  std::promise<void> release = hold(compiler);
  compiler.compileAhead(kernelOf("first ahead"));
  compiler.compileAhead(kernelOf("second ahead"));
  std::promise<void> told;
  compiler.compile(kernelOf("awaited"), [&] { told.set_value(); });
  release.set_value();
  told.get_future().wait();
  while (compiled().size() < 3) std::this_thread::yield();
  EXPECT_THAT(compiled(), ElementsAre("awaited", "first ahead", "second ahead"));
}

TEST_F(KernelCompilerTest, pausesBeforeItTriesAKernelAgainThatHadNoMemory) {
  const auto begun = std::chrono::steady_clock::now();
  KernelCompiler compiler(1, failTest);
  askAgain(compiler);
  while (askedCount() < 3) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_GE(std::chrono::steady_clock::now() - begun, 2 * KernelCompiler::kPause);
  compiler.drain();
}

TEST_F(KernelCompilerTest, tellsNobodyOnceItIsDrained) {
  KernelCompiler compiler(1, failTest);
  std::promise<void> begun;
  MissingKernels kernels;
  kernels.emplace(&begun, [&begun] {
    begun.set_value();
    std::this_thread::sleep_for(std::chrono::milliseconds(50));  // while it is drained
    throw std::bad_alloc();
  });
  std::atomic<bool> is_told = false;
  compiler.compile(std::move(kernels), [&] { is_told = true; });
  begun.get_future().wait();
  compiler.drain();
  std::this_thread::sleep_for(KernelCompiler::kPause + std::chrono::milliseconds(100));
  EXPECT_FALSE(is_told);
}

TEST_F(KernelCompilerTest, takesOneThreadForAKernelHoweverManyWaitForIt) {
  KernelCompiler compiler(2, failTest);
  std::promise<void> release;
  const std::shared_future<void> held = release.get_future().share();
  std::atomic<int> begun_count = 0;
  std::atomic<int> told_count = 0;
  for (int i = 0; i < 3; ++i) {
    compiler.compile(sharedKernel(held, begun_count), [&] { ++told_count; });
    while (begun_count == 0) std::this_thread::yield();
  }
  std::promise<void> told;
  compiler.compile(kernelOf("other"), [&] { told.set_value(); });
  EXPECT_EQ(told.get_future().wait_for(std::chrono::seconds(10)), std::future_status::ready)
      << "the second thread waits for what the first one compiles";
  EXPECT_EQ(told_count, 0);
  release.set_value();
  while (told_count < 3) std::this_thread::yield();
  EXPECT_EQ(begun_count, 1);
}

TEST_F(KernelCompilerTest, compilesAKernelOnceForAllWhoWaitForItInTheQueue) {
  KernelCompiler compiler(1, failTest);
  std::promise<void> release = hold(compiler);
  std::atomic<int> begun_count = 0;
  std::atomic<int> told_count = 0;
  std::promise<void> go_on;
  go_on.set_value();
  const std::shared_future<void> free = go_on.get_future().share();
  for (int i = 0; i < 2; ++i) {
    MissingKernels kernels = sharedKernel(free, begun_count);
    kernels.merge(kernelOf(i == 0 ? "first" : "second"));
    compiler.compile(std::move(kernels), [&] { ++told_count; });
  }
  release.set_value();
  while (told_count < 2) std::this_thread::yield();
  EXPECT_EQ(begun_count, 1);
  EXPECT_THAT(compiled(), ElementsAre("first", "second"));
}

TEST_F(KernelCompilerTest, compilesOthersInThePauseOfOneThatHadNoMemory) {
  KernelCompiler compiler(1, failTest);
  askAgain(compiler);
  std::promise<void> told;
  compiler.compile(kernelOf("other"), [&] { told.set_value(); });
  told.get_future().wait();
  EXPECT_THAT(compiled(), ElementsAre("other"));
  compiler.drain();
}

}  // namespace
}  // namespace viewloom::kernel_compiler_test
