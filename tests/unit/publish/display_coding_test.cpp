// SPDX-License-Identifier: Apache-2.0
// Quality of a display before lines that change their speed, with a clock that is turned by hand.
#include "publish/display_coding.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "unit/publish/simulated_line.h"

namespace viewloom::test::display_coding_test {
namespace {

constexpr int64_t kMs = 1'000'000;
constexpr int64_t kSecond = 1'000 * kMs;
constexpr EncodingSpec kEncoding = {
    .color = BandEncoding::kH264, .video_qp = 24, .video_qp_max = 40};

// A Portrait quilt of the built-in scene.
uint64_t bytesAt(uint32_t qp) {
  return uint64_t(370'000 * std::pow(0.68, (double(qp) - 24) / 4));
}

// A reader that takes the newest atlas when its socket has the last one, as calls do.
class Reader {
 public:
  Reader(DisplayCoding& coding, uint64_t number, double mbit_per_second)
      : coding_(coding), number_(number), line_(mbit_per_second) {
    coding_.join(number_, Payer("client " + std::to_string(number_)));
  }

  void setSpeed(double mbit_per_second, int64_t now_ns) {
    line_.setSpeed(mbit_per_second, now_ns);
    // A write that waits is through at another time now.
    if (is_writing_) taken_ns_ = line_.write(0, now_ns);
  }

  void offer(uint64_t bytes, int64_t now_ns) { waiting_ = {bytes, now_ns}; }

  void runUntil(int64_t now_ns) {
    if (is_writing_ && taken_ns_ <= now_ns) {
      coding_.endAtlas(number_, taken_ns_);
      arrived_ns_.push_back(line_.throughNs(now_ns));
      latencies_ns_.push_back(arrived_ns_.back() - made_ns_);
      is_writing_ = false;
    }
    if (is_writing_ || waiting_.bytes == 0 || !coding_.mayBegin(number_, now_ns)) return;
    is_writing_ = true;
    made_ns_ = waiting_.made_ns;
    coding_.beginWrite(number_, waiting_.bytes, now_ns);
    taken_ns_ = line_.write(waiting_.bytes, now_ns);
    sent_bytes_ += waiting_.bytes;
    waiting_ = {};
  }

  // The longest time without an atlas that began after `from_ns`.
  int64_t longestGapNs(int64_t from_ns, int64_t until_ns) const {
    int64_t longest_ns = 0;
    int64_t last_ns = from_ns;
    for (const int64_t arrived_ns : arrived_ns_) {
      if (arrived_ns < from_ns || arrived_ns > until_ns) continue;
      longest_ns = std::max(longest_ns, arrived_ns - std::exchange(last_ns, arrived_ns));
    }
    return std::max(longest_ns, until_ns - last_ns);
  }
  int64_t longestLatencyNs(int64_t from_ns, int64_t until_ns) const {
    int64_t longest_ns = 0;
    for (size_t i = 0; i < arrived_ns_.size(); ++i) {
      const bool counts = arrived_ns_[i] >= from_ns && arrived_ns_[i] <= until_ns;
      if (counts) longest_ns = std::max(longest_ns, latencies_ns_[i]);
    }
    return longest_ns;
  }
  uint64_t sentBytes() const { return sent_bytes_; }

 private:
  struct Waiting {
    uint64_t bytes = 0;  // 0 = none
    int64_t made_ns = 0;
  };

  DisplayCoding& coding_;
  const uint64_t number_;
  SimulatedLine line_;
  Waiting waiting_;
  bool is_writing_ = false;
  int64_t taken_ns_ = 0;
  int64_t made_ns_ = 0;
  uint64_t sent_bytes_ = 0;
  std::vector<int64_t> arrived_ns_;
  std::vector<int64_t> latencies_ns_;
};

class DisplayCodingTest : public testing::Test {
 protected:
  // Thirty atlases a second, for all readers alike.
  void runUntil(int64_t end_ns, const std::vector<Reader*>& readers, bool has_frames = true) {
    for (; now_ns_ < end_ns; now_ns_ += kMs) {
      if (has_frames && now_ns_ >= next_frame_ns_) {
        next_frame_ns_ = now_ns_ + kSecond / 30;
        makeAtlas(readers);
      }
      for (Reader* const reader : readers) reader->runUntil(now_ns_);
    }
  }

  void makeAtlas(const std::vector<Reader*>& readers) {
    qp_ = coding_.beginAtlas(now_ns_);
    coding_.noteCoded(qp_, bytesAt(qp_));
    for (Reader* const reader : readers) reader->offer(bytesAt(qp_), now_ns_);
  }

  DisplayCoding coding_{kEncoding};
  int64_t now_ns_ = 0;
  int64_t next_frame_ns_ = 0;
  uint32_t qp_ = 0;
};

TEST_F(DisplayCodingTest, followsALineDownAndUpWithoutAGap) {
  Reader reader(coding_, 1, 100);
  runUntil(5 * kSecond, {&reader});
  EXPECT_EQ(qp_, 24u);
  reader.setSpeed(20, now_ns_);
  runUntil(15 * kSecond, {&reader});
  EXPECT_GE(qp_, 36u);
  reader.setSpeed(100, now_ns_);
  runUntil(30 * kSecond, {&reader});
  EXPECT_EQ(qp_, 24u);
  EXPECT_LT(reader.longestGapNs(kSecond, 30 * kSecond), kSecond / 2);
  // Latency is bounded, and grows no further while the line is slow.
  EXPECT_LT(reader.longestLatencyNs(6 * kSecond, 10 * kSecond), 300 * kMs);
  EXPECT_LE(reader.longestLatencyNs(10 * kSecond, 15 * kSecond),
            reader.longestLatencyNs(6 * kSecond, 10 * kSecond));
  EXPECT_LT(reader.longestLatencyNs(17 * kSecond, 30 * kSecond), 150 * kMs);
}

TEST_F(DisplayCodingTest, followsTheMedianReader) {
  Reader fast(coding_, 1, 1000);
  Reader other(coding_, 2, 1000);
  Reader slow(coding_, 3, 10);
  runUntil(5 * kSecond, {&fast, &other, &slow});
  EXPECT_EQ(qp_, 24u) << "the slow one skips atlases";
  EXPECT_LT(slow.sentBytes() * 5, fast.sentBytes());
  fast.setSpeed(20, now_ns_);
  runUntil(10 * kSecond, {&fast, &other, &slow});
  EXPECT_GE(qp_, 36u) << "two of three are slow";
  coding_.leave(1);
  coding_.leave(3);
  runUntil(20 * kSecond, {&other});
  EXPECT_EQ(qp_, 24u);
}

TEST_F(DisplayCodingTest, wantsTheFinestOnceFramesStand) {
  Reader reader(coding_, 1, 20);
  runUntil(5 * kSecond, {&reader});
  EXPECT_GE(qp_, 36u);
  EXPECT_FALSE(coding_.wantsFiner(now_ns_));
  runUntil(5 * kSecond + 600 * kMs, {&reader}, false);
  EXPECT_TRUE(coding_.wantsFiner(now_ns_));
  EXPECT_TRUE(coding_.isWanted());
  EXPECT_FALSE(coding_.wantsFiner(now_ns_)) << "it is asked for already";
  makeAtlas({&reader});
  EXPECT_EQ(qp_, 24u);
  EXPECT_FALSE(coding_.isWanted());
  runUntil(8 * kSecond, {&reader}, false);
  EXPECT_FALSE(coding_.wantsFiner(now_ns_)) << "it is the finest";
  EXPECT_EQ(coding_.beginAgain(now_ns_), 24u) << "somebody joins";
  makeAtlas({&reader});
  EXPECT_GE(qp_, 32u) << "frames move again";
}

TEST_F(DisplayCodingTest, wantsTheFinestAlsoWhereOneReaderOfTwoTakesNothing) {
  Reader reader(coding_, 1, 20);
  runUntil(5 * kSecond, {&reader});
  coding_.join(2, Payer("client 2"));
  coding_.beginWrite(2, 1'000'000, now_ns_);
  runUntil(7 * kSecond, {&reader}, false);
  EXPECT_TRUE(coding_.wantsFiner(now_ns_));
}

TEST_F(DisplayCodingTest, leavesSlowFramesAsTheyAre) {
  Reader reader(coding_, 1, 0.2);
  for (int i = 0; i < 5; ++i) {
    makeAtlas({&reader});
    runUntil(now_ns_ + kSecond, {&reader}, false);
    EXPECT_FALSE(i > 1 && coding_.wantsFiner(now_ns_)) << "the next frame comes after a second";
  }
}

TEST_F(DisplayCodingTest, wantsTheFinestOfFramesThatComeNowAndThen) {
  Reader reader(coding_, 1, 1);
  runUntil(5 * kSecond, {&reader});
  runUntil(60 * kSecond, {&reader}, false);
  makeAtlas({&reader});
  EXPECT_GT(qp_, 24u);
  runUntil(62 * kSecond, {&reader}, false);
  EXPECT_FALSE(coding_.wantsFiner(now_ns_));
  runUntil(64 * kSecond, {&reader}, false);
  EXPECT_TRUE(coding_.wantsFiner(now_ns_));
}

// Bits a second that a reader of a fast line gets, on average over a minute.
double limitedRate(const EncodingSpec& encoding) {
  DisplayCoding coding(encoding);
  Reader reader(coding, 1, 1000);
  for (int64_t now_ns = 0; now_ns < 60 * kSecond; now_ns += kMs) {
    if (now_ns % (40 * kMs) == 0) {
      const uint32_t qp = coding.beginAtlas(now_ns);
      coding.noteCoded(qp, bytesAt(qp));
      reader.offer(bytesAt(qp), now_ns);
    }
    reader.runUntil(now_ns);
  }
  return double(reader.sentBytes()) * 8 / 60;
}

TEST(DisplayCodingLimitTest, keepsAReaderToItsBits) {
  EncodingSpec encoding = kEncoding;
  for (const uint64_t bits_max : {5'000'000U, 1'000'000U, 200'000U}) {
    encoding.bits_per_second_max = bits_max;
    EXPECT_LT(limitedRate(encoding), 1.1 * double(bits_max)) << bits_max;
    EXPECT_GT(limitedRate(encoding), 0.7 * double(bits_max)) << bits_max;
  }
  encoding.bits_per_second_max = 1;
  EXPECT_LT(limitedRate(encoding), 8 * double(bytesAt(24)) / 60 + 1) << "one atlas";
  encoding.bits_per_second_max = UINT64_MAX;
  EXPECT_GT(limitedRate(encoding), 8 * 20 * double(bytesAt(24)));
}

TEST(DisplayCodingLimitTest, refinesStandingFramesAsFarAsTheirBitsFitIntoASecond) {
  EncodingSpec encoding = kEncoding;
  encoding.bits_per_second_max = 2'000'000;
  DisplayCoding coding(encoding);
  Reader reader(coding, 1, 1000);
  uint32_t qp = 0;
  for (int64_t now_ns = 0; now_ns < 3 * kSecond; now_ns += kSecond / 30) {
    qp = coding.beginAtlas(now_ns);
    coding.noteCoded(qp, bytesAt(qp));
  }
  EXPECT_EQ(qp, 40u);
  ASSERT_TRUE(coding.wantsFiner(4 * kSecond));
  EXPECT_EQ(coding.beginAtlas(4 * kSecond), 32u) << "370 kB at the finest, 171 kB two steps above";
  EXPECT_FALSE(coding.wantsFiner(9 * kSecond));
}

TEST(DisplayCodingLimitTest, keepsToItsBitsWhereNoQuantisationIsCoarser) {
  constexpr EncodingSpec kCoarsest = {
      .color = BandEncoding::kH264, .video_qp = 51, .bits_per_second_max = 100'000};
  EXPECT_TRUE(adaptsToLines(kCoarsest));
  EXPECT_LT(limitedRate(kCoarsest), 1.5 * 100'000);
}

}  // namespace
}  // namespace viewloom::test::display_coding_test
