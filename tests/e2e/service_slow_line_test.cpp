// SPDX-License-Identifier: Apache-2.0
// Video of a whole server over a line whose speed changes.
#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "e2e/arrivals.h"
#include "e2e/service_fixture.h"
#include "e2e/slow_line.h"
#include "lib/watcher.h"

namespace viewloom::test::service_slow_line_test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr int64_t kMs = 1'000'000;
constexpr uint32_t kFinestQp = 20;

uint64_t bytesOf(const Atlas& atlas) {
  uint64_t bytes = 0;
  for (const AtlasBand& band : atlas.bands) bytes += band.bytes.size();
  return bytes;
}

// Thread-safety: all methods may be called from any thread.
class SeenAtlases {
 public:
  void add(const Arrival& arrival) {
    std::lock_guard lock(mutex_);
    all_.push_back(arrival);
    came_.notify_all();
  }
  std::vector<Arrival> all() const {
    std::lock_guard lock(mutex_);
    return all_;
  }
  bool waitForQp(uint32_t qp, seconds patience) {
    return waitFor(patience, [&](const Arrival& newest) { return newest.qp == qp; });
  }
  bool waitForRung(uint32_t rung, seconds patience) {
    return waitFor(patience, [&](const Arrival& newest) { return newest.rung == rung; });
  }

 private:
  template <typename Predicate>
  bool waitFor(seconds patience, const Predicate& is_wanted) {
    std::unique_lock lock(mutex_);
    return came_.wait_for(lock, patience, [&] { return !all_.empty() && is_wanted(all_.back()); });
  }

  mutable std::mutex mutex_;
  std::condition_variable came_;
  std::vector<Arrival> all_;
};

int64_t longestLatencyNs(const std::vector<Arrival>& atlases) {
  int64_t longest_ns = 0;
  for (const Arrival& arrival : atlases) {
    longest_ns = std::max(longest_ns, arrival.latency_ns);
  }
  return longest_ns;
}

// Publishes ten frames a second, each with the time of its capture, until it goes.
class MovingScene {
 public:
  MovingScene(const std::string& address, const Clock& clock)
      : publisher_(makeChannel(address), {.stream = "scene", .session_id = "", .backoff = {}}, {}),
        thread_([this, &clock](const std::stop_token& stop) {
          for (int number = 0; !stop.stop_requested(); ++number) {
            WireFrame frame = syntheticWireFrame({320, 320}, 1, 0.1 * number);
            frame.header.set_capture_time_ns(clock.nowNs());
            publisher_.offer(std::move(frame));
            std::this_thread::sleep_for(milliseconds(100));
          }
        }) {}

 private:
  Publisher publisher_;
  std::jthread thread_;
};

class ServiceSlowLineTest : public ServiceFixture {
 protected:
  // Fine video of which each atlas has some hundred kilobytes, or fewer for a smaller quilt.
  static v1::OpenDisplay fineVideo(SizePx size_px = {1600, 1600}) {
    v1::OpenDisplay open = openQuilt("scene", size_px);
    open.mutable_encoding()->set_color(v1::BAND_ENCODING_H264);
    open.mutable_encoding()->set_video_qp(kFinestQp);
    open.mutable_encoding()->set_bits_per_second_max(1'000'000'000);
    return open;
  }

  // Notes the atlases that come in `seen`, which outlives the watcher.
  WatcherCallbacks noteIn(SeenAtlases& seen) const {
    return {.on_layout = {},
            .on_atlas =
                [this, &seen](const Atlas& atlas) {
                  const int64_t now_ns = clock_.nowNs();
                  seen.add({.at_ns = now_ns,
                            .latency_ns = now_ns - atlas.header.capture_time_ns(),
                            .bytes = bytesOf(atlas),
                            .frame_number = atlas.header.frame_number(),
                            .qp = atlas.header.video_qp(),
                            .rung = atlas.layout->video_rung()});
                },
            .on_connection = {},
            .on_message = {}};
  }

  // The time now, after as long a wait.
  int64_t after(seconds wait) {
    std::this_thread::sleep_for(wait);
    return clock_.nowNs();
  }

  std::vector<Arrival> tell(const char* phase, int64_t from_ns, int64_t until_ns) {
    const std::vector<Arrival> seen = between(seen_.all(), from_ns, until_ns);
    std::printf("%s: %zu atlases, longest gap %.0f ms, longest latency %.0f ms, QP %u, %.0f kB\n",
                phase, seen.size(), double(longestGapNs(seen)) * 1e-6,
                double(longestLatencyNs(seen)) * 1e-6, seen.empty() ? 0 : seen.back().qp,
                seen.empty() ? 0.0 : double(seen.back().bytes) * 1e-3);
    return seen;
  }

  SeenAtlases seen_;
};

TEST_F(ServiceSlowLineTest, followsALineDownAndUp) {
  SlowLine line(service_->grpcAddress(), 1000);
  Watcher watcher(makeChannel(line.address()), fineVideo(), noteIn(seen_));
  std::optional<MovingScene> scene(std::in_place, service_->grpcAddress(), clock_);
  ASSERT_TRUE(seen_.waitForQp(kFinestQp, kGiveUpAfter));
  const int64_t fast_ns = after(seconds(1));
  const int64_t slow_ns = after(seconds(4));
  const std::vector<Arrival> fast = tell("fast line", fast_ns, slow_ns);
  ASSERT_GT(fast.size(), 4u);
  // A quarter of what the display takes.
  const double taken_mbit = double(fast.back().bytes) * 8e-6 * double(fast.size()) / 4;
  line.setSpeed(taken_mbit / 4);
  const int64_t settled_ns = after(seconds(1));
  const int64_t middle_ns = after(seconds(3));
  const int64_t again_ns = after(seconds(3));
  const std::vector<Arrival> early = tell("slow line, first half", settled_ns, middle_ns);
  const std::vector<Arrival> late = tell("slow line, second half", middle_ns, again_ns);
  line.setSpeed(1000);
  EXPECT_TRUE(seen_.waitForQp(kFinestQp, seconds(25)));
  tell("fast line again", again_ns, clock_.nowNs());

  ASSERT_FALSE(late.empty());
  EXPECT_GT(late.back().qp, kFinestQp + 4);
  EXPECT_LE(late.back().qp, kFinestQp + 16);
  // Other work of the machine delays frames before the line, too.
  const int64_t gap_max_ns = 500 * kMs + longestGapNs(fast);
  EXPECT_LT(longestGapNs(early), gap_max_ns);
  EXPECT_LT(longestGapNs(late), gap_max_ns);
  EXPECT_LT(longestLatencyNs(late), longestLatencyNs(early) + 200 * kMs);
  EXPECT_EQ(watcher.counts().reconnects, 0u);
}

// The quilt is small, so that two cores have time for a second encoding.
TEST_F(ServiceSlowLineTest, movesASlowReaderToASecondRungAndBack) {
  constexpr SizePx kSmall_px = {800, 800};
  SlowLine line(service_->grpcAddress(), 1000);
  SeenAtlases slow;
  Watcher near(makeChannel(service_->grpcAddress()), fineVideo(kSmall_px), noteIn(seen_));
  Watcher far(makeChannel(line.address()), fineVideo(kSmall_px), noteIn(slow));
  const MovingScene scene(service_->grpcAddress(), clock_);
  ASSERT_TRUE(seen_.waitForQp(kFinestQp, kGiveUpAfter));
  ASSERT_TRUE(slow.waitForRung(1, kGiveUpAfter));
  const int64_t both_ns = after(seconds(1));
  const int64_t slow_ns = after(seconds(3));
  const std::vector<Arrival> before = between(seen_.all(), both_ns, slow_ns);
  ASSERT_GT(before.size(), 4u);
  const double taken_mbit = double(before.back().bytes) * 8e-6 * double(before.size()) / 3;
  line.setSpeed(taken_mbit / 4);
  ASSERT_TRUE(slow.waitForRung(2, kGiveUpAfter));
  const int64_t moved_ns = after(seconds(2));
  const int64_t again_ns = after(seconds(3));
  const std::vector<Arrival> coarse = between(slow.all(), moved_ns, again_ns);
  const std::vector<Arrival> fine = between(seen_.all(), moved_ns, again_ns);
  std::printf("second rung: %zu atlases of %zu, QP %u beside %u\n", coarse.size(), fine.size(),
              coarse.empty() ? 0 : coarse.back().qp, fine.empty() ? 0 : fine.back().qp);
  ASSERT_FALSE(coarse.empty() || fine.empty());
  EXPECT_TRUE(
      std::ranges::all_of(coarse, [](const Arrival& arrival) { return arrival.rung == 2; }));
  EXPECT_TRUE(std::ranges::all_of(fine, [](const Arrival& arrival) { return arrival.rung == 1; }));
  EXPECT_EQ(fine.back().qp, kFinestQp);
  EXPECT_GT(coarse.back().qp, kFinestQp + 4);
  EXPECT_GT(2 * coarse.size(), fine.size()) << "on the first rung it got a quarter of them";
  EXPECT_GE(service_->metrics().rung_moves[VideoRung::kSecond].value(), 1);
  line.setSpeed(1000);
  EXPECT_TRUE(slow.waitForRung(1, kGiveUpAfter));
  EXPECT_EQ(far.counts().reconnects + near.counts().reconnects, 0u);
}

TEST_F(ServiceSlowLineTest, sendsTheFinestAtlasOnceFramesStand) {
  SlowLine line(service_->grpcAddress(), 1);
  Watcher watcher(makeChannel(line.address()), fineVideo(), noteIn(seen_));
  {
    const MovingScene scene(service_->grpcAddress(), clock_);
    ASSERT_TRUE(seen_.waitForQp(kFinestQp + 16, kGiveUpAfter));
  }
  ASSERT_TRUE(seen_.waitForQp(kFinestQp, kGiveUpAfter));
  const std::vector<Arrival> seen = seen_.all();
  EXPECT_EQ(seen.back().frame_number, seen[seen.size() - 2].frame_number);
}

}  // namespace
}  // namespace viewloom::test::service_slow_line_test
