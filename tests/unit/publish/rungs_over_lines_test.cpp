// SPDX-License-Identifier: Apache-2.0
// Readers of one display before lines of different speeds, with a clock that is turned by hand.
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "unit/publish/simulated_line.h"
#include "unit/publish/watcher.h"

namespace viewloom::test::rungs_over_lines_test {
namespace {

constexpr int64_t kMs = 1'000'000;
constexpr int64_t kSecond = 1'000 * kMs;
constexpr int64_t kAtlasesPerSecond = 30;
constexpr EncodingSpec kAdapting = {
    .color = BandEncoding::kH264, .video_qp = 24, .video_qp_max = 40};

// A Portrait quilt of the built-in scene: 89 Mbit/s at the finest.
uint64_t bytesAt(uint32_t qp) {
  return uint64_t(370'000 * std::pow(0.68, (double(qp) - 24) / 4));
}

// Takes the newest atlas when its socket has the last one, as calls do.
class LineReader {
 public:
  LineReader(SubscriptionPtr place, double mbit_per_second)
      : place_(std::move(place)), line_(mbit_per_second) {}

  void setSpeed(double mbit_per_second, int64_t now_ns) {
    line_.setSpeed(mbit_per_second, now_ns);
    // A write that waits is through at another time now.
    if (is_writing_) taken_ns_ = line_.write(0, now_ns);
  }
  void offer(uint64_t bytes) { waiting_bytes_ = bytes; }
  void runUntil(int64_t now_ns) {
    if (is_writing_ && taken_ns_ <= now_ns) {
      place_->endAtlas(taken_ns_);
      ++taken_count_;
      is_writing_ = false;
    }
    if (is_writing_ || waiting_bytes_ == 0) return;
    is_writing_ = true;
    place_->beginWrite(waiting_bytes_, now_ns);
    taken_ns_ = line_.write(std::exchange(waiting_bytes_, 0), now_ns);
  }

  Broadcaster::Subscription& place() const { return *place_; }
  void move(SubscriptionPtr place) {
    place_ = std::move(place);
    waiting_bytes_ = 0;
  }
  // Atlases since the last such call.
  int takeCount() { return std::exchange(taken_count_, 0); }

 private:
  SubscriptionPtr place_;
  SimulatedLine line_;
  uint64_t waiting_bytes_ = 0;  // 0 = no atlas waits
  bool is_writing_ = false;
  int64_t taken_ns_ = 0;
  int taken_count_ = 0;
};

class RungsOverLinesTest : public testing::Test {
 protected:
  LineReader reader(double mbit_per_second) {
    return {join(broadcaster_, "s", quiltOf(2), std::make_shared<Watcher>(), kAdapting),
            mbit_per_second};
  }

  void runUntil(int64_t end_ns, const std::vector<LineReader*>& readers) {
    for (; now_ns_ < end_ns; now_ns_ += kMs) {
      if (now_ns_ >= next_frame_ns_) makeAtlases(readers);
      for (LineReader* const reader : readers) reader->runUntil(now_ns_);
      if (now_ns_ % (250 * kMs) == 0) followLines(readers);
    }
  }

  void makeAtlases(const std::vector<LineReader*>& readers) {
    next_frame_ns_ = now_ns_ + kSecond / kAtlasesPerSecond;
    const std::vector<ActiveDisplayPtr> displays = broadcaster_.displays("s");
    display_count_max_ = std::max(display_count_max_, displays.size());
    std::map<uint64_t, uint64_t> bytes;
    for (const ActiveDisplayPtr& display : displays) {
      const uint32_t qp = display->coding->beginAtlas(now_ns_);
      display->coding->noteCoded(qp, bytesAt(qp));
      display->coding->noteCodingTime(10 * kMs);
      bytes[display->id] = bytesAt(qp);
    }
    for (LineReader* const reader : readers) reader->offer(bytes[reader->place().displayId()]);
  }

  void followLines(const std::vector<LineReader*>& readers) {
    used_ns_ += 100 * kMs;
    broadcaster_.remakeStanding(now_ns_);
    for (LineReader* const reader : readers) {
      const std::optional<RungMove> wanted = reader->place().wantedMove(now_ns_);
      if (!wanted) continue;
      auto place = broadcaster_.moveToRung(*wanted, std::make_shared<Watcher>(), now_ns_);
      if (!place.ok()) continue;
      reader->move(*std::move(place));
      ++move_count_;
    }
  }

  uint32_t qpOf(const LineReader& reader) const {
    return broadcaster_.display(reader.place().displayId())->coding->qp();
  }

  int64_t now_ns_ = 0;
  int64_t next_frame_ns_ = 0;
  int64_t used_ns_ = 0;
  int move_count_ = 0;
  size_t display_count_max_ = 0;
  CodingRoom room_{2, [this] { return used_ns_; }};
  Broadcaster broadcaster_{{}, unboundedMemory(), room_};
};

TEST_F(RungsOverLinesTest, giveASlowReaderAllAtlasesOnceItHasMoved) {
  LineReader fast = reader(1000);
  LineReader slow = reader(40);
  runUntil(3 * kSecond, {&fast, &slow});
  EXPECT_EQ(slow.place().rung(), VideoRung::kFirst);
  EXPECT_LT(slow.takeCount(), 2 * kAtlasesPerSecond);
  runUntil(8 * kSecond, {&fast, &slow});
  EXPECT_EQ(slow.place().rung(), VideoRung::kSecond);
  fast.takeCount();
  slow.takeCount();
  runUntil(13 * kSecond, {&fast, &slow});
  EXPECT_GE(slow.takeCount(), 5 * kAtlasesPerSecond - 10);
  EXPECT_GE(fast.takeCount(), 5 * kAtlasesPerSecond - 10);
  EXPECT_EQ(qpOf(fast), 24u);
  EXPECT_GE(qpOf(slow), 32u);
}

TEST_F(RungsOverLinesTest, doNotSendReadersToAndFro) {
  LineReader fast = reader(1000);
  LineReader slow = reader(10);
  LineReader medium = reader(60);
  runUntil(60 * kSecond, {&fast, &slow, &medium});
  EXPECT_EQ(move_count_, 1);
  EXPECT_EQ(slow.place().rung(), VideoRung::kSecond);
  EXPECT_EQ(medium.place().rung(), VideoRung::kFirst) << "it gets more than every other atlas";
}

TEST_F(RungsOverLinesTest, takeAReaderBackWithItsLine) {
  LineReader fast = reader(1000);
  LineReader slow = reader(10);
  runUntil(20 * kSecond, {&fast, &slow});
  EXPECT_EQ(slow.place().rung(), VideoRung::kSecond);
  slow.setSpeed(1000, now_ns_);
  runUntil(30 * kSecond, {&fast, &slow});
  EXPECT_EQ(slow.place().rung(), VideoRung::kFirst);
  EXPECT_EQ(move_count_, 2);
  EXPECT_EQ(broadcaster_.displays("s").size(), 1u) << "nobody is left on the second";
  EXPECT_EQ(qpOf(slow), 24u);
}

TEST_F(RungsOverLinesTest, areTwoAtMost) {
  std::vector<LineReader> all;
  for (const double mbit : {200, 200, 200, 200, 30, 12, 4}) all.push_back(reader(mbit));
  std::vector<LineReader*> readers;
  for (LineReader& one : all) readers.push_back(&one);
  runUntil(20 * kSecond, readers);
  EXPECT_EQ(display_count_max_, 2u);
  EXPECT_EQ(all.front().place().rung(), VideoRung::kFirst);
  EXPECT_EQ(all.back().place().rung(), VideoRung::kSecond);
}

}  // namespace
}  // namespace viewloom::test::rungs_over_lines_test
