// SPDX-License-Identifier: Apache-2.0
// Work that cannot be broken off, and a signal.
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "cli/interrupt.h"

namespace viewloom::cli::interrupt_limit_test {
namespace {

void workForLong() {
  std::this_thread::sleep_for(std::chrono::minutes(1));
}

void workThatIsInterrupted(int signal) {
  catchInterrupts();
  const InterruptLimit limit([] { std::fputs("kept; ", stderr); });
  std::raise(signal);
  workForLong();
  std::exit(0);
}

TEST(InterruptLimit, endsTheProcessByTheSignalAndKeepsWhatThereIs) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  for (const int signal : {SIGINT, SIGTERM}) {
    EXPECT_EXIT(workThatIsInterrupted(signal), testing::KilledBySignal(signal),
                "kept; viewloom: ended before its work was done");
  }
}

void workThatEndsInTime() {
  catchInterrupts();
  {
    const InterruptLimit limit([] { std::fputs("kept; ", stderr); });
    std::raise(SIGINT);
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(1200));
  std::exit(7);
}

TEST(InterruptLimit, leavesACommandAloneThatEndsInTime) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(workThatEndsInTime(), testing::ExitedWithCode(7), "^$");
}

void workThatIsNotCaughtYet() {
  std::raise(SIGTERM);
  std::exit(0);
}

TEST(InterruptLimit, isNotNeededBeforeSignalsAreCaught) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(workThatIsNotCaughtYet(), testing::KilledBySignal(SIGTERM), "");
}

}  // namespace
}  // namespace viewloom::cli::interrupt_limit_test
