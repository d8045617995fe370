// SPDX-License-Identifier: Apache-2.0
// Frames that wait in the intake because the sink does not want them.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <latch>
#include <map>
#include <mutex>
#include <new>
#include <string>
#include <thread>

#include "unit/decode/held_sink.h"

namespace viewloom::unwanted_frames_test {
namespace {

using test::HeldSink;
using test::onePixel;
using test::Reports;

// Wants no frame before it is told to.
class ShutSink : public HeldSink {
 public:
  bool wantsFrame(const std::string&) override { return is_open; }
  std::atomic<bool> is_open = false;
};

TEST(UnwantedFrames, dropsTheFrameThatWaitsOfAStreamThatIsForgotten) {
  ShutSink sink;
  Reports reports;
  ManualClock clock;
  BytePool pool(16);
  std::atomic<int> taken_count = 0;
  FrameIntake intake(sink, clock, pool, {.thread_count = 1});
  intake.offer("a", onePixel(1), {}, reports.into("a"), [&] { ++taken_count; });
  EXPECT_TRUE(intake.forget("a"));
  EXPECT_EQ(taken_count, 1);
  sink.is_open = true;
  intake.offer("b", onePixel(2), {}, reports.into("b"));
  intake.close();
  EXPECT_EQ(reports.outcomes("a")[1], FrameOutcome::kRefused);
  EXPECT_TRUE(sink.offered("a").empty());
  EXPECT_EQ(sink.offered("b"), std::vector<uint64_t>{2});
  EXPECT_TRUE(intake.forget("never seen"));
}

// Wants the frames of one stream, and counts how often it is asked about others.
class OneStreamSink : public HeldSink {
 public:
  bool wantsFrame(const std::string& stream) override {
    if (stream == "wanted") return true;
    std::lock_guard lock(mutex_);
    ++asked_[stream];
    return false;
  }
  int askedCount(const std::string& stream) {
    std::lock_guard lock(mutex_);
    return asked_[stream];
  }

 private:
  std::mutex mutex_;
  std::map<std::string, int> asked_;
};

TEST(UnwantedFrames, asksAgainAboutAStreamOnceItMayBeWantedAndNotBefore) {
  constexpr int kFrames = 50;
  OneStreamSink sink;
  Reports reports;
  ManualClock clock;
  BytePool pool(16);
  FrameIntake intake(sink, clock, pool, {.thread_count = 2});
  for (const std::string stream : {"a", "b"}) {
    intake.offer(stream, onePixel(1), {}, reports.into(stream));
  }
  for (int number = 1; number <= kFrames; ++number) {
    std::latch is_taken(1);
    intake.offer("wanted", onePixel(uint64_t(number)), {}, reports.into("wanted"),
                 [&] { is_taken.count_down(); });
    is_taken.wait();
  }
  EXPECT_EQ(sink.askedCount("a"), 1);
  intake.resume("a");
  while (sink.askedCount("a") < 2) std::this_thread::yield();
  EXPECT_TRUE(intake.forget("a") && intake.forget("b")) << "waits until the sink is not asked";
  EXPECT_EQ(sink.askedCount("b"), 1);
}

// Has no memory to know whether it wants a frame.
class ScarceSink : public HeldSink {
 public:
  bool wantsFrame(const std::string&) override {
    ++asked_count;
    if (is_scarce) throw std::bad_alloc();
    return true;
  }
  std::atomic<bool> is_scarce = true;
  std::atomic<int> asked_count = 0;
};

TEST(UnwantedFrames, asksNowAndThenWhereThereIsNoMemory) {
  ScarceSink sink;
  Reports reports;
  ManualClock clock;
  BytePool pool(16);
  FrameIntake intake(sink, clock, pool, {.thread_count = 1});
  intake.offer("a", onePixel(1), {}, reports.into("a"));
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  EXPECT_LE(sink.asked_count, 10);
  sink.is_scarce = false;
  while (sink.offered("a").empty()) std::this_thread::yield();
  intake.close();
}

TEST(UnwantedFrames, isClosedWhereThereIsNoMemory) {
  ScarceSink sink;
  Reports reports;
  ManualClock clock;
  BytePool pool(16);
  FrameIntake intake(sink, clock, pool, {.thread_count = 1});
  intake.offer("a", onePixel(1), {}, reports.into("a"));
  while (sink.asked_count == 0) std::this_thread::yield();
  intake.close();
  EXPECT_EQ(sink.offered("a"), std::vector<uint64_t>{1});
}

}  // namespace
}  // namespace viewloom::unwanted_frames_test
