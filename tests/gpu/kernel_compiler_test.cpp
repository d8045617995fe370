// SPDX-License-Identifier: Apache-2.0
// In which order kernels are compiled, and whom that tells. No device is needed.
#include "walk/kernel_compiler.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <future>
#include <mutex>
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
  static void failTest(const std::exception& error) { ADD_FAILURE() << error.what(); }

 private:
  char places_[16] = {};
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

}  // namespace
}  // namespace viewloom::kernel_compiler_test
