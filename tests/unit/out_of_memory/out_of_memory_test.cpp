// SPDX-License-Identifier: Apache-2.0
// Each large allocation on the way of a request fails in turn: the request is refused, and the next
// one is served.
#include "admission/request_boundary.h"

#include <gtest/gtest.h>

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "base/worker_pool.h"
#include "decode/frame_intake.h"
#include "encode/band_encoder.h"
#include "frame/limits.h"
#include "support/failing_allocations.h"
#include "unit/decode/zstd_samples.h"

namespace viewloom::out_of_memory_test {
namespace {

constexpr uint64_t kRanksMax = 1000;

using Arm = std::function<void()>;

// Calls `attempt` again and again. From its call of `arm` on, the first allocation fails, then the
// second, and so on, until none does. Returns in how many attempts one has failed.
uint64_t failEachIn(const std::function<void(const Arm& arm)>& attempt) {
  for (uint64_t rank = 0; rank < kRanksMax; ++rank) {
    attempt([rank] { test::failAllocation(rank); });
    if (!test::stopFailing()) return rank;
  }
  ADD_FAILURE() << "allocations never end";
  return kRanksMax;
}

CollectedFrame packedFrame(uint64_t number) {
  constexpr SizePx kSize_px{96, 64};
  const std::vector<uint8_t> depth(kSize_px.area() * 4, 1);
  PlaneFormat packed{.kind = PlaneKind::kDepth,
                     .encoding = PlaneEncoding::kDepthF32,
                     .size_px = kSize_px,
                     .compression = PlaneCompression::kZstd};
  const std::vector<uint8_t> wire = zstdFrame(depth, ZstdSize::kStated);
  packed.wire_bytes = wire.size();
  PlaneFormat color{
      .kind = PlaneKind::kColor, .encoding = PlaneEncoding::kRgb8, .size_px = kSize_px};
  color.wire_bytes = uncompressedBytes(color);
  CollectedFrame frame{
      .format = {.number = number, .sources = {{.layers = {{.color = color, .depth = packed}}}}},
      .planes = {}};
  frame.planes = {std::make_shared<const std::vector<uint8_t>>(color.wire_bytes, uint8_t{9}),
                  std::make_shared<const std::vector<uint8_t>>(wire)};
  return frame;
}

class CountingSink : public FrameSink {
 public:
  void offerFrame(const FrameOrigin&, FramePtr frame, ReportFrame report) override {
    report({.number = frame->format.number, .outcome = FrameOutcome::kTraced});
  }
  void forgetStream(const std::string&) override {}
};

// The report of one frame.
class Report {
 public:
  ReportFrame take() {
    return [this](const FrameReport& report) {
      std::lock_guard lock(mutex_);
      EXPECT_FALSE(outcome_) << "two reports of one frame";
      outcome_ = report.outcome;
      reason_ = report.reason;
      told_.notify_all();
    };
  }
  FrameOutcome wait() {
    std::unique_lock lock(mutex_);
    told_.wait(lock, [this] { return outcome_.has_value(); });
    return *outcome_;
  }
  std::string reason() {
    std::lock_guard lock(mutex_);
    return reason_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable told_;
  std::optional<FrameOutcome> outcome_;
  std::string reason_;
};

TEST(OutOfMemory, refusesTheFrameThatIsDecodedAndTakesTheNext) {
  CountingSink sink;
  ManualClock clock;
  uint64_t number = 0;
  const uint64_t failed_count = failEachIn([&](const Arm& arm) {
    BytePool pool(0);
    FrameIntake intake(sink, clock, pool, {.thread_count = 1});
    CollectedFrame frame = packedFrame(++number);
    Report first;
    arm();
    intake.offer("a", std::move(frame), {}, first.take());
    if (first.wait() == FrameOutcome::kRefused) {
      EXPECT_NE(first.reason().find("no memory left"), std::string::npos) << first.reason();
    }
    test::stopFailing();
    Report next;
    intake.offer("a", packedFrame(++number), {}, next.take());
    EXPECT_EQ(next.wait(), FrameOutcome::kTraced);
  });
  EXPECT_GT(failed_count, 0u);
}

TEST(OutOfMemory, endsNoThreadOfAWorkerPool) {
  WorkerPool workers(3);
  EXPECT_THROW(workers.forEach(100,
                               [](uint32_t index, uint32_t) {
                                 if (index == 50) throw std::bad_alloc();
                               }),
               std::bad_alloc);
  std::atomic<uint32_t> piece_count = 0;
  workers.forEach(100, [&](uint32_t, uint32_t) { ++piece_count; });
  EXPECT_EQ(piece_count, 100u);
}

TEST(OutOfMemory, leavesAnEncoderFitForTheNextBand) {
  BytePool pool(0);
  BandEncoder encoder(pool);
  constexpr uint32_t kWidth_px = 4096;
  constexpr uint32_t kRows = 128;
  const std::vector<uint8_t> rgba(size_t{kWidth_px} * kRows * 4, 77);
  AtlasLayout layout;
  layout.size_px = layout.tile_size_px = {kWidth_px, kRows};
  const BandPixels band{.row_count = kRows,
                        .width_px = kWidth_px,
                        .bytes = rgba,
                        .stride_bytes = size_t{kWidth_px} * 4};
  for (const BandEncoding color : {BandEncoding::kJpeg, BandEncoding::kZstd, BandEncoding::kRaw}) {
    const EncodingSpec encoding{.color = color};
    const size_t expected_bytes = BandEncoder(pool).encode(band, encoding, layout).bytes->size();
    failEachIn([&](const Arm& arm) {
      arm();
      const absl::Status status = unlessThrown([&] {
        encoder.encode(band, encoding, layout);
        return absl::OkStatus();
      });
      const bool has_failed = test::stopFailing();
      EXPECT_EQ(status.code() == absl::StatusCode::kResourceExhausted, has_failed);
      EXPECT_EQ(encoder.encode(band, encoding, layout).bytes->size(), expected_bytes);
    });
  }
}

TEST(OutOfMemory, isWorthAnotherTry) {
  const absl::Status status = unlessThrown([]() -> absl::Status { throw std::bad_alloc(); });
  EXPECT_EQ(status.code(), absl::StatusCode::kResourceExhausted);
  EXPECT_NE(status.message().find("try again later"), std::string::npos);
}

}  // namespace
}  // namespace viewloom::out_of_memory_test
