// SPDX-License-Identifier: Apache-2.0
// Memory of a stream and a display is bounded, and the reported sizes are the real ones.
#include "bench/memory_use.h"

#include <cstring>
#include <memory>
#include <utility>

#include <gtest/gtest.h>

#include "bench/bench_views.h"
#include "support/test_device.h"
#include "synthetic/synthetic_frame.h"

namespace viewloom::bench::memory_use_test {
namespace {

constexpr uint64_t kMib = 1 << 20;
// Beside slots and planes: command buffers, descriptors, what a driver keeps of a submission.
constexpr uint64_t kSmallThings_bytes = 8 * kMib;
constexpr float kWall_inv_z = 0.25F;  // 1/m

// A wall in every layer.
Frame wallFrame(SizePx size_px, uint32_t layer_count) {
  std::vector<uint8_t> depth(size_px.area() * sizeof(float));
  for (size_t i = 0; i < depth.size(); i += sizeof(float)) {
    std::memcpy(&depth[i], &kWall_inv_z, sizeof(float));
  }
  const LayerPlanes planes{
      .color = std::make_shared<std::vector<uint8_t>>(size_px.area() * 4, uint8_t{255}),
      .depth = std::make_shared<std::vector<uint8_t>>(std::move(depth))};
  LayerFormat format;
  format.color = {.kind = PlaneKind::kColor, .size_px = size_px};
  format.depth = {
      .kind = PlaneKind::kDepth, .encoding = PlaneEncoding::kDepthF32, .size_px = size_px};
  format.depth.depth = {.meaning = DepthMeaning::kDisparity};
  Frame frame;
  frame.format.sources.emplace_back().camera = syntheticCamera(size_px);
  frame.format.sources.front().layers.assign(layer_count, format);
  frame.sources.emplace_back(layer_count, planes);
  return frame;
}

TraceJob quiltJob(const Frame& frame, const char* preset) {
  constexpr double kSpan_px = 18;
  const Camera& camera = frame.format.sources.front().camera;
  const SizePx size_px = frame.format.sources.front().layers.front().depth.size_px;
  const double inv_z{kWall_inv_z};
  const SourceView source{
      .camera = camera,
      .size_px = size_px,
      .stats = {.inv_z_min = inv_z, .inv_z_max = inv_z, .inv_z_near = inv_z, .inv_z_far = inv_z}};
  DisplaySpec spec;
  spec.tolerance_px = kDefaultTolerance_px;
  return makeTraceJob(std::make_shared<AtlasLayout>(quiltOfSpan(source, preset, kSpan_px)), spec,
                      camera.pose, camera, size_px);
}

class MemoryUseTest : public GpuTest {
 protected:
  static void checkFrame(const Frame& frame, const char* preset, uint64_t total_bytes_max) {
    const TraceJob job = quiltJob(frame, preset);
    const MemoryUse walked = walkMemory(device(), frame, job);
    check(walked, total_bytes_max);
    EXPECT_LE(2 * walked.further_frame_bytes, walked.totalBytes());
    if (!canMeasureSweeps()) return;
    WorkerPool workers(2);
    const auto plan = SweepPlan::make(job, double{kWall_inv_z});
    ASSERT_TRUE(plan.has_value());
    check(sweepMemory(frame, job, *plan, workers), total_bytes_max);
  }

 private:
  static void check(const MemoryUse& use, uint64_t total_bytes_max) {
    EXPECT_LE(use.totalBytes(), total_bytes_max);
    EXPECT_LE(use.further_frame_bytes, use.totalBytes());
    if (!use.peak_bytes) return;
    EXPECT_GE(*use.peak_bytes, use.totalBytes());
    EXPECT_LE(*use.peak_bytes, use.totalBytes() + kSmallThings_bytes);
  }
};

TEST_F(MemoryUseTest, fitsAPortraitQuiltOf1080pFramesOfTwoLayersInto160MiB) {
  checkFrame(wallFrame({1920, 1080}, 2), "portrait", 160 * kMib);
}

TEST_F(MemoryUseTest, fitsThe32InchQuiltOf4KFramesOfFourLayersIntoAGiB) {
  checkFrame(wallFrame({3840, 2160}, 4), "32_gen3_l", 1024 * kMib);
}

}  // namespace
}  // namespace viewloom::bench::memory_use_test
