// SPDX-License-Identifier: Apache-2.0
// Kernels are compiled on threads of their own: who waits for them keeps nobody from his pictures.
#include <gmock/gmock.h>

#include <condition_variable>
#include <mutex>

#include "e2e/pipeline_fixture.h"
#include "walk/walk_engine.h"

namespace viewloom::test::pipeline_compile_test {
namespace {

using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

// Holds every kernel that is to be compiled, while it is told to. Thread-safety: all methods may be
// called from any thread.
class HeldCompiler {
 public:
  void beforeEach() {
    std::unique_lock lock(mutex_);
    ++asked_count_;
    changed_.notify_all();
    changed_.wait(lock, [this] { return !is_held_; });
  }
  void hold() {
    std::lock_guard lock(mutex_);
    is_held_ = true;
    asked_count_ = 0;
  }
  // Until it holds one.
  void waitUntilAsked() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return asked_count_ > 0; });
  }
  void release() {
    std::lock_guard lock(mutex_);
    is_held_ = false;
    changed_.notify_all();
  }
  int askedCount() {
    std::lock_guard lock(mutex_);
    return asked_count_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool is_held_ = false;
  int asked_count_ = 0;
};

DisplaySpec lensQuilt() {
  DisplaySpec spec = smallQuilt({128, 80});
  spec.lens = LensSpec{
      .aperture_radius_m = 0.01, .focus_distance_m = 2, .walked_count = 2, .gathered_count = 0};
  return spec;
}

class PipelineCompileTest : public PipelineFixture {
 protected:
  // Engines as on a GPU: only the walk, compiled on its own threads.
  ServerOptions ownThreads() {
    return {.make_engines = [this](const Device& device) {
      Engines engines{.all = {}, .workers = std::make_unique<WorkerPool>()};
      engines.all.push_back(std::make_unique<WalkEngine>(
          device, WalkOptions{.compile_place = CompilePlace::kOwnThreads,
                              .before_each_kernel = [this] { compiler_.beforeEach(); }}));
      return engines;
    }};
  }

  HeldCompiler compiler_;
};

TEST_F(PipelineCompileTest, aPictureThatWaitsForItsKernelsKeepsNoOtherFromItsFrames) {
  Server server(device(), ownThreads());
  const Viewer quick = watch(server, smallQuilt({128, 80}));
  const FramePtr first = syntheticFrame(1);
  server.offer(first);
  ASSERT_THAT(quick.subscriber->waitForAtlases(1), SizeIs(1));
  compiler_.hold();
  const Viewer slow = watch(server, lensQuilt());
  compiler_.waitUntilAsked();
  constexpr uint64_t kLast = 6;
  for (uint64_t number = 2; number <= kLast; ++number) {
    server.offer(movedFrame(*first, number));
    ASSERT_THAT(quick.subscriber->waitForAtlases(number), SizeIs(number));
  }
  EXPECT_THAT(slow.subscriber->waitForAtlases(0), IsEmpty());
  compiler_.release();
  const std::vector<AtlasPtr> late = slow.subscriber->waitForAtlases(1);
  ASSERT_THAT(late, Not(IsEmpty()));
  EXPECT_EQ(late.front()->frame_number, kLast) << "it waited with a frame that was no news";
}

TEST_F(PipelineCompileTest, aPictureBeginsWithTheFrameThatCameWhileItsKernelsCompiled) {
  Server server(device(), ownThreads());
  const FramePtr first = syntheticFrame(1);
  {
    const Viewer quick = watch(server, smallQuilt({128, 80}));
    server.offer(first);
    ASSERT_THAT(quick.subscriber->waitForAtlases(1), SizeIs(1));
  }
  compiler_.hold();
  const Viewer slow = watch(server, lensQuilt());
  compiler_.waitUntilAsked();
  server.offer(movedFrame(*first, 2));
  compiler_.release();
  const std::vector<AtlasPtr> late = slow.subscriber->waitForAtlases(1);
  ASSERT_THAT(late, Not(IsEmpty()));
  EXPECT_EQ(late.front()->frame_number, 2u) << "the one before was older";
}

TEST_F(PipelineCompileTest, picturesAreThoseOfKernelsThatTheRecordingThreadCompiles) {
  Server here(device());
  Server apart(device(), ownThreads());
  for (const DisplaySpec& spec : {lensQuilt(), turnedCamera()}) {
    const Viewer expected = watch(here, spec);
    const Viewer got = watch(apart, spec);
    here.offer(syntheticFrame(1));
    apart.offer(syntheticFrame(1));
    const std::vector<AtlasPtr> a = expected.subscriber->waitForAtlases(1);
    const std::vector<AtlasPtr> b = got.subscriber->waitForAtlases(1);
    ASSERT_THAT(a, Not(IsEmpty()));
    ASSERT_THAT(b, Not(IsEmpty()));
    ASSERT_EQ(a.front()->bands.size(), b.front()->bands.size());
    for (size_t i = 0; i < a.front()->bands.size(); ++i) {
      EXPECT_EQ(*a.front()->bands[i].bytes, *b.front()->bands[i].bytes) << "band " << i;
    }
  }
  EXPECT_GT(compiler_.askedCount(), 0);
}

TEST_F(PipelineCompileTest, aFrameThatWaitsForItsKernelsKeepsNoOtherStreamFromItsFrames) {
  Server server(device(), ownThreads());
  const DisplaySpec spec = smallQuilt({128, 80});
  const Viewer quick = watch(server, spec);
  const Viewer slow = watch(server, spec, {}, "flat");
  const FramePtr first = syntheticFrame(1);
  server.offer(first);
  ASSERT_THAT(quick.subscriber->waitForAtlases(1), SizeIs(1));
  compiler_.hold();
  // Kernels of one layer.
  const FramePtr flat = syntheticFrame(1, {160, 90}, 1);
  server.offer(flat, "flat");
  compiler_.waitUntilAsked();
  for (uint64_t number = 2; number <= 4; ++number) {
    server.offer(movedFrame(*first, number));
    ASSERT_THAT(quick.subscriber->waitForAtlases(number), SizeIs(number));
  }
  server.offer(movedFrame(*flat, 2), "flat");
  EXPECT_THAT(slow.subscriber->waitForAtlases(0), IsEmpty());
  compiler_.release();
  const std::vector<AtlasPtr> late = slow.subscriber->waitForAtlases(1);
  ASSERT_THAT(late, Not(IsEmpty()));
  EXPECT_EQ(late.front()->frame_number, 2u) << "the newest frame of those that waited";
}

TEST_F(PipelineCompileTest, aServerEndsWhileFramesWaitForTheirKernels) {
  compiler_.hold();
  std::optional<Server> server(std::in_place, device(), ownThreads());
  const Viewer viewer = watch(*server, lensQuilt());
  server->offer(syntheticFrame(1));
  compiler_.waitUntilAsked();
  std::jthread releaser([this] { compiler_.release(); });
  server->pipeline.drain();
  EXPECT_THAT(server->reports.waitForReports(1), SizeIs(1));
}

TEST_F(PipelineCompileTest, aServerEndsWhilePicturesWaitForTheirKernels) {
  std::optional<Server> server(std::in_place, device(), ownThreads());
  const Viewer quick = watch(*server, smallQuilt({128, 80}));
  server->offer(syntheticFrame(1));
  ASSERT_THAT(quick.subscriber->waitForAtlases(1), SizeIs(1));
  compiler_.hold();
  const Viewer viewer = watch(*server, lensQuilt());
  compiler_.waitUntilAsked();
  std::jthread releaser([this] { compiler_.release(); });
  server->pipeline.drain();
  EXPECT_THAT(server->reports.waitForReports(1), SizeIs(1));
}

}  // namespace
}  // namespace viewloom::test::pipeline_compile_test
