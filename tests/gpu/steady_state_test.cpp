// SPDX-License-Identifier: Apache-2.0
// Once warm, frames become atlases in memory that is already there.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "decode/frame_intake.h"
#include "engine/make_engines.h"
#include "gpu/buffer.h"
#include "pipeline/pipeline.h"
#include "support/large_allocations.h"
#include "support/test_device.h"
#include "unit/decode/jpeg_samples.h"
#include "unit/decode/zstd_samples.h"

namespace viewloom::steady_state_test {
namespace {

constexpr SizePx kFramePx{480, 270};
// How many strips and bands are under way at once varies with the machine's load, so the pools may
// meet their peak late: they get a few rounds until one passes without any allocation.
constexpr int kRoundsMax = 6;
constexpr uint64_t kRoundFrames = 8;
// Planes of one frame and what they inflate from, for the frames that wait, are decoded, uploaded.
constexpr size_t kPooledBuffers = 64;

using Bytes = std::vector<uint8_t>;

// A slanted plane at 2..4 m that moves from frame to frame.
Bytes depthBytes(uint64_t number) {
  std::vector<float> depth_m(kFramePx.area());
  for (uint64_t i = 0; i < depth_m.size(); ++i) {
    depth_m[i] = 2 + static_cast<float>((i + 7 * number) % kFramePx.width) / 240;
  }
  const auto* bytes = reinterpret_cast<const uint8_t*>(depth_m.data());
  return {bytes, bytes + depth_m.size() * sizeof(float)};
}

// Two layers: JPEG and packed depth, then RGB8 and zstd depth, so that every decoder works.
CollectedFrame makeFrame(uint64_t number) {
  const Bytes depth = depthBytes(number);
  CollectedFrame frame;
  const auto add = [&frame](PlaneFormat& plane, Bytes bytes) {
    plane.wire_bytes = bytes.size();
    frame.planes.push_back(std::make_shared<const Bytes>(std::move(bytes)));
  };
  LayerFormat front;
  front.color = {.encoding = PlaneEncoding::kJpeg, .size_px = kFramePx};
  front.depth = {
      .kind = PlaneKind::kDepth, .encoding = PlaneEncoding::kDepthF32, .size_px = kFramePx};
  LayerFormat back = front;
  back.color.encoding = PlaneEncoding::kRgb8;
  back.depth.compression = PlaneCompression::kZstd;
  back.depth.depth.offset = 1;
  add(front.color, sampleJpeg(kFramePx, JpegSort::kBaseline));
  add(front.depth, depth);
  add(back.color, Bytes(kFramePx.area() * 3, 90));
  add(back.depth, zstdFrame(depth, ZstdSize::kStated));
  SourceFormat source;
  source.camera.intrinsics = intrinsicsFromFov({-0.5, 0.5, 0.3, -0.3}, kFramePx);
  source.camera.pose.position_m.x = 0.01 * static_cast<double>(number);
  source.layers = {front, back};
  frame.format = {.number = number, .sources = {source}};
  return frame;
}

DisplaySpec quilt(uint32_t columns, uint32_t rows, SizePx size_px) {
  QuiltSpec spec;
  spec.columns = columns;
  spec.rows = rows;
  spec.size_px = size_px;
  spec.view_cone_rad = 0.5;
  spec.focal_distance_m = 3;
  absl::StatusOr<DisplaySpec> complete = completeDisplaySpec({.kind = spec, .world_pose = {}});
  EXPECT_EQ(complete.status(), absl::OkStatus());
  return *std::move(complete);
}

DisplaySpec smallQuilt() {
  return quilt(4, 2, {512, 512});
}

// The most views that a display may have. It stands still while the source's camera moves, so that
// every frame shows each of its views anew.
DisplaySpec fixedQuiltOfManyViews() {
  DisplaySpec spec = quilt(50, 50, {400, 400});
  spec.world_pose = Pose{};
  return spec;
}

// Above the source, so that it is walked.
DisplaySpec raisedQuilt() {
  DisplaySpec spec = smallQuilt();
  spec.world_pose = Pose{.position_m = {0, 0.05, 0}};
  return spec;
}

// Keeps the newest atlas, as a client's mailbox does.
class NewestAtlas : public Subscriber {
 public:
  void offer(AtlasPtr atlas) override { newest_ = std::move(atlas); }
  void end(const absl::Status&) override {}

 private:
  AtlasPtr newest_;
};

// Waits for the report of each frame.
class ReportBox {
 public:
  void put(const FrameReport& report) {
    std::lock_guard lock(mutex_);
    report_ = report;
    arrived_.notify_one();
  }
  FrameReport wait() {
    std::unique_lock lock(mutex_);
    arrived_.wait(lock, [this] { return report_.has_value(); });
    FrameReport report = *std::move(report_);
    report_.reset();
    return report;
  }

 private:
  std::mutex mutex_;
  std::condition_variable arrived_;
  std::optional<FrameReport> report_;
};

class SteadyState : public GpuTest {
 protected:
  // From the bytes of the wire to the atlases of all displays.
  void passFrame(CollectedFrame frame) {
    intake_->offer("s", std::move(frame), {}, [this](const FrameReport& r) { box_.put(r); });
    const FrameReport report = box_.wait();
    ASSERT_EQ(report.outcome, FrameOutcome::kTraced) << report.reason;
    ASSERT_EQ(report.displays.size(), subscriptions_.size());
  }

  void SetUp() override {
    GpuTest::SetUp();
    if (IsSkipped()) return;
    engines_ = makeEngines(device());
    const PipelineLinks links{
        engines_,     clock_,     metrics_,
        broadcaster_, directory_, [](const std::exception& error) { FAIL() << error.what(); }};
    pipeline_ = std::make_unique<Pipeline>(links, PipelineOptions{});
    broadcaster_.onDemandChange([this](const std::string& s) { pipeline_->serveDisplays(s); });
    intake_ = std::make_unique<FrameIntake>(*pipeline_, clock_, pool_, FrameIntakeOptions{});
    pipeline_->onWanted([this](const std::string& s) { intake_->resume(s); });
    claim_ = *directory_.claim("s", "", [] {});
  }

  void TearDown() override {
    if (intake_) intake_->close();
    if (pipeline_) pipeline_->drain();
    subscriptions_.clear();
    GpuTest::TearDown();
  }

  void watch(const DisplaySpec& display, const EncodingSpec& encoding) {
    subscriptions_.push_back(
        *broadcaster_.subscribe("s", display, encoding, std::make_shared<NewestAtlas>()));
  }

  SteadyClock clock_;
  Metrics metrics_;
  Broadcaster broadcaster_{{}};
  StreamDirectory directory_{clock_, 4};
  BytePool pool_{kPooledBuffers};
  ReportBox box_;
  Engines engines_;
  std::unique_ptr<Pipeline> pipeline_;
  std::unique_ptr<FrameIntake> intake_;
  std::unique_ptr<StreamDirectory::Claim> claim_;
  std::vector<std::unique_ptr<Broadcaster::Subscription>> subscriptions_;
};

TEST_F(SteadyState, allocatesNothingLargeFromWireToAtlas) {
  if (!test::countsLargeAllocations()) GTEST_SKIP() << "a sanitizer owns the heap";
  watch(smallQuilt(), {});
  watch(smallQuilt(), {.chroma = Chroma::k444, .with_depth = true, .with_mask = true});
  watch(smallQuilt(), {.color = BandEncoding::kRaw});
  watch(fixedQuiltOfManyViews(), {});
  watch(raisedQuilt(), {});
  uint64_t number = 0;
  for (int round = 0; round < kRoundsMax; ++round) {
    std::vector<CollectedFrame> frames;
    for (uint64_t i = 0; i < kRoundFrames; ++i) frames.push_back(makeFrame(++number));
    const uint64_t heap_before = test::largeAllocationCount();
    const uint64_t gpu_before = gpuAllocationCount();
    for (CollectedFrame& frame : frames) ASSERT_NO_FATAL_FAILURE(passFrame(std::move(frame)));
    const uint64_t heap_count = test::largeAllocationCount() - heap_before;
    const uint64_t gpu_count = gpuAllocationCount() - gpu_before;
    if (round > 0 && heap_count == 0 && gpu_count == 0) return;
    ASSERT_TRUE(round > 0 || (heap_count > 0 && gpu_count > 0)) << "nothing is counted";
  }
  FAIL() << "every round of " << kRoundFrames << " frames allocates";
}

}  // namespace
}  // namespace viewloom::steady_state_test
