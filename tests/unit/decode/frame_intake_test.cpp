// SPDX-License-Identifier: Apache-2.0
#include "decode/frame_intake.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "unit/decode/held_sink.h"

namespace viewloom::frame_intake_test {
namespace {

using test::HeldSink;
using test::onePixel;
using test::Reports;

class FrameIntakeTest : public testing::Test {
 protected:
  void offer(const std::string& stream, CollectedFrame frame, FrameTimes times = {}) {
    intake_.offer(stream, std::move(frame), times, reports_.into(stream));
  }

  HeldSink sink_;
  Reports reports_;
  ManualClock clock_;
  BytePool pool_{16};
  std::atomic<int> replaced_count_ = 0;
  FrameIntake intake_{
      sink_, clock_, pool_, {.thread_count = 3, .on_replaced = [this] { ++replaced_count_; }}};
};

// Takes no frame.
class FailingSink : public FrameSink {
 public:
  void offerFrame(const FrameOrigin&, FramePtr, ReportFrame) override {
    ++offered_count;
    throw std::runtime_error("planted");
  }
  void forgetStream(const std::string&) override {}
  std::atomic<int> offered_count = 0;
};

TEST(FrameIntake, goesOnAfterAFrameThatNobodyCouldTake) {
  FailingSink sink;
  ManualClock clock;
  BytePool pool(16);
  FrameIntake intake(sink, clock, pool, {.thread_count = 1});
  for (int number = 1; number <= 2; ++number) {
    intake.offer("a", onePixel(uint64_t(number)), {}, [](const FrameReport&) {});
    while (sink.offered_count < number) std::this_thread::yield();
  }
  intake.close();
  EXPECT_EQ(sink.offered_count, 2);
}

TEST_F(FrameIntakeTest, forgetsNoStreamOfWhichAFrameIsHandedOver) {
  sink_.hold();
  offer("a", onePixel(1));
  sink_.waitForOffer();
  EXPECT_FALSE(intake_.forget("a"));
  sink_.letGo();
  intake_.close();
  EXPECT_TRUE(intake_.forget("a"));
  EXPECT_EQ(reports_.outcomes("a")[1], FrameOutcome::kTraced);
}

TEST_F(FrameIntakeTest, deliversADecodedFrameWithItsTimes) {
  clock_.advance(99);
  offer("a", onePixel(1), {.first_chunk_ns = 10, .last_chunk_ns = 20});
  intake_.close();
  EXPECT_EQ(sink_.offered("a"), std::vector<uint64_t>{1});
  EXPECT_EQ(sink_.newest()->times.first_chunk_ns, 10);
  EXPECT_EQ(sink_.newest()->times.last_chunk_ns, 20);
  EXPECT_EQ(sink_.newest()->times.decoded_ns, 100);
  EXPECT_EQ(reports_.outcomes("a"), (std::map<uint64_t, FrameOutcome>{{1, FrameOutcome::kTraced}}));
}

TEST_F(FrameIntakeTest, replacesTheFrameThatStillWaits) {
  sink_.hold();
  offer("a", onePixel(1));
  sink_.waitForOffer();
  for (const uint64_t number : {2U, 3U, 4U}) offer("a", onePixel(number));
  EXPECT_EQ(reports_.outcomes("a"),
            (std::map<uint64_t, FrameOutcome>{{2, FrameOutcome::kReplaced},
                                              {3, FrameOutcome::kReplaced}}));
  EXPECT_EQ(replaced_count_, 2);
  sink_.letGo();
  intake_.close();
  EXPECT_EQ(sink_.offered("a"), (std::vector<uint64_t>{1, 4}));
}

TEST_F(FrameIntakeTest, letsOtherStreamsPassABusyOne) {
  sink_.hold();
  offer("a", onePixel(1));
  sink_.waitForOffer();
  offer("a", onePixel(2));
  offer("b", onePixel(1));
  while (sink_.offered("b").empty()) std::this_thread::yield();
  EXPECT_EQ(sink_.offered("a"), std::vector<uint64_t>{1});
  sink_.letGo();
}

// The newest of those that wait is next.
class LastFirstSink : public HeldSink {
 public:
  size_t nextToDecode(const std::vector<FrameOrigin>& waiting) override {
    return waiting.size() - 1;
  }
  void noteDecoded(const FrameOrigin& origin, int64_t cpu_ns) override {
    EXPECT_GE(cpu_ns, 0);
    decoded.push_back(origin.stream);
    spent_ns += cpu_ns;
  }

  std::vector<std::string> decoded;  // on one thread
  int64_t spent_ns = 0;
};

TEST(FrameIntake, decodesInTheOrderOfTheSink) {
  LastFirstSink sink;
  ManualClock clock;
  BytePool pool(16);
  FrameIntake intake(sink, clock, pool, {.thread_count = 1});
  sink.hold();
  intake.offer("first", onePixel(1), {}, [](const FrameReport&) {});
  sink.waitForOffer();
  for (const bool is_broken : {false, true}) {
    intake.offer(is_broken ? "broken" : "whole", onePixel(1, is_broken), {},
                 [](const FrameReport&) {});
  }
  sink.letGo();
  intake.close();
  EXPECT_EQ(sink.decoded, (std::vector<std::string>{"first", "broken", "whole"}))
      << "paid for also where it fails";
}

TEST(FrameIntake, countsTheTimeThatAFrameTookWhileItCame) {
  LastFirstSink sink;
  ManualClock clock;
  BytePool pool(16);
  FrameIntake intake(sink, clock, pool, {.thread_count = 1});
  CollectedFrame frame = onePixel(1);
  frame.arrival_ns = 3'600'000'000'000;
  intake.offer("large", std::move(frame), {}, [](const FrameReport&) {});
  intake.close();
  EXPECT_GE(sink.spent_ns, 3'600'000'000'000);
}

TEST_F(FrameIntakeTest, putsEveryPlaneInItsPlaceWhoeverDecodesIt) {
  constexpr uint8_t kLayers = 4;
  constexpr uint64_t kFrames = 200;
  CollectedFrame frame = onePixel(1);
  frame.format.sources[0].layers.resize(kLayers, frame.format.sources[0].layers[0]);
  frame.planes.clear();
  for (uint8_t plane = 0; plane < kLayers; ++plane) {
    frame.planes.push_back(std::make_shared<const std::vector<uint8_t>>(4, plane));
    frame.planes.push_back(std::make_shared<const std::vector<uint8_t>>(2, uint8_t(plane + 100)));
  }
  for (frame.format.number = 1; frame.format.number <= kFrames; ++frame.format.number) {
    offer("a", {.format = frame.format, .planes = frame.planes});
  }
  intake_.close();
  const FramePtr newest = sink_.newest();
  EXPECT_EQ(newest->format.number, kFrames);
  for (uint8_t layer = 0; layer < kLayers; ++layer) {
    EXPECT_EQ(*newest->sources[0][layer].color, std::vector<uint8_t>(4, layer));
    EXPECT_EQ(*newest->sources[0][layer].depth, std::vector<uint8_t>(2, uint8_t(layer + 100)));
  }
}

TEST_F(FrameIntakeTest, refusesABrokenFrameAndGoesOn) {
  offer("a", onePixel(1, true));
  offer("b", onePixel(1));
  intake_.close();
  EXPECT_EQ(reports_.outcomes("a"),
            (std::map<uint64_t, FrameOutcome>{{1, FrameOutcome::kRefused}}));
  EXPECT_EQ(reports_.reason("a").rfind("header.sources[0].layers[0].planes[1]: ", 0), 0U);
  EXPECT_EQ(sink_.offered("b"), std::vector<uint64_t>{1});
}

TEST_F(FrameIntakeTest, refusesFramesOnceClosed) {
  intake_.close();
  offer("a", onePixel(1));
  EXPECT_EQ(reports_.outcomes("a"),
            (std::map<uint64_t, FrameOutcome>{{1, FrameOutcome::kRefused}}));
  EXPECT_TRUE(sink_.offered("a").empty());
}

TEST_F(FrameIntakeTest, reportsEveryFrameOnceAndKeepsTheOrderOfEachStream) {
  constexpr uint64_t kFrames = 400;
  const std::vector<std::string> streams{"a", "b", "c", "d", "e"};
  std::vector<std::jthread> publishers;
  for (const std::string& stream : streams) {
    publishers.emplace_back([this, &stream] {
      for (uint64_t number = 1; number <= kFrames; ++number) {
        offer(stream, onePixel(number, number % 7 == 0));
      }
    });
  }
  publishers.clear();
  intake_.close();
  for (const std::string& stream : streams) {
    EXPECT_EQ(reports_.outcomes(stream).size(), kFrames);
    const std::vector<uint64_t> offered = sink_.offered(stream);
    EXPECT_TRUE(std::is_sorted(offered.begin(), offered.end()));
    const uint64_t newest = kFrames - (kFrames % 7 == 0);
    EXPECT_EQ(reports_.outcomes(stream).at(newest), FrameOutcome::kTraced);
  }
}

}  // namespace
}  // namespace viewloom::frame_intake_test
