// SPDX-License-Identifier: Apache-2.0
// Kernels of likely displays are compiled while nobody needs the device, and a few at a time.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <vector>

#include "base/clock.h"
#include "picture/trace_job.h"
#include "support/test_device.h"
#include "support/test_frames.h"
#include "walk/walk_engine.h"
#include "walk/warm_up.h"

namespace viewloom::work_ahead_test {
namespace {

constexpr SizePx kSource_px{64, 48};
constexpr int kFrames = 2;  // that it builds first, a piece each

class WorkAheadTest : public GpuTest {
 protected:
  static uint64_t kernelCount() { return device().kernelCount(); }
};

TEST_F(WorkAheadTest, restsOnceSomebodyHasNeededTheDevice) {
  WalkEngine engine(device(), {.warms_up = true});
  engine.connect(
      {.on_room = [] {},
       .on_failure = [](const std::exception& error) { ADD_FAILURE() << error.what(); }});
  const auto frame = engine.preparer()->make();
  frame->take(test::syntheticFrame(1, kSource_px, 1));
  frame->reserve();
  frame->prepare(SteadyClock(), {});
  const uint64_t before = kernelCount();
  const auto pause = engine.workAhead();
  ASSERT_TRUE(pause.has_value()) << "it has not compiled anything yet";
  EXPECT_GT(pause->count(), 0);
  EXPECT_LE(pause->count(), DeviceUse::kRest_ns);
  EXPECT_EQ(kernelCount(), before) << "a picture of this frame would have waited for that";
  engine.drain();
}

TEST_F(WorkAheadTest, compilesFewKernelsAtATimeForPictures) {
  StructureWorks works(device());
  ViewTracer tracer(device());
  WarmUp warm_up(works, tracer);
  for (int i = 0; i < kFrames; ++i) ASSERT_TRUE(warm_up.makeNext({}));
  // Means along both axes, or the walk and what sums its light.
  constexpr uint64_t kKernelsMax = 2;
  uint64_t most = 0;
  for (int piece = 0; piece < 4; ++piece) {
    const uint64_t before = kernelCount();
    ASSERT_TRUE(warm_up.makeNext({}));
    most = std::max(most, kernelCount() - before);
  }
  EXPECT_GT(most, 0u);
  EXPECT_LE(most, kKernelsMax);
}

TEST_F(WorkAheadTest, beginsWithWhatPagesNeedThatLookAround) {
  StructureWorks works(device());
  ViewTracer tracer(device());
  WarmUp warm_up(works, tracer);
  for (int piece = 0; piece < kFrames + 4; ++piece) ASSERT_TRUE(warm_up.makeNext({}));
  const FramePtr frame = test::syntheticFrame(1, {128, 96});
  FrameStructure structure(device(), shapesOf(*frame));
  structure.upload(*frame);
  CommandRecorder recorder(device());
  structure.recordBuild(recorder.begin(), works.builder);
  works.timeline.wait(recorder.submit(works.timeline));
  const std::vector<SeenSource> sources{seenSource(frame->format.sources.front())};
  const Camera& camera = sources.front().camera;
  for (const TraceOutputs& outputs : {TraceOutputs{}, TraceOutputs{.depth = true}}) {
    const DisplaySpec spec = *completeDisplaySpec(
        {.kind = StereoSpec{.layout = StereoLayout::kSingle, .eye_size_px = {64, 48}},
         .world_pose = Pose{.position_m = {0.1, -0.05, 0.02}}});
    const auto layout = makeAtlasLayout(
        spec,
        streamDefaults(camera.intrinsics, sources.front().size_px, structure.stats().front()));
    const TraceJob job = makeTraceJob(std::make_shared<AtlasLayout>(layout.value()), spec,
                                      displayPose(spec, camera), sources);
    TraceOutputs planes = outputs;
    planes.color = tracer.colorForm(ColorForm::kYcbcr420);
    EXPECT_TRUE(tracer.missing(structure.parts(), job, planes).empty())
        << (outputs.depth ? "with depth" : "colour alone");
  }
}

// Whoever submits beside it would cut his work into ever smaller pieces, each of which waits again.
TEST_F(WorkAheadTest, takesItsTimeForItself) {
  StructureWorks works(device());
  ViewTracer tracer(device());
  WarmUp warm_up(works, tracer);
  const int64_t begun_ns = wallTimeNs();
  ASSERT_TRUE(warm_up.makeNext({}));
  const int64_t passed_ns = wallTimeNs() - begun_ns;
  // Somebody who submitted at the same time is done right after it.
  EXPECT_LT(works.clock.noteDone(begun_ns), passed_ns / 2);
}

}  // namespace
}  // namespace viewloom::work_ahead_test
