// SPDX-License-Identifier: Apache-2.0
// First pieces of the largest work, before anything was measured: none is predicted to take longer
// than a piece may.
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "base/clock.h"
#include "base/cost_estimate.h"
#include "gpu/world_views.h"
#include "picture/display_sources.h"
#include "support/test_device.h"
#include "support/test_frames.h"
#include "walk/walk_engine.h"

namespace viewloom::first_pieces_test {
namespace {

// Rows as wide as can be.
constexpr SizePx kAtlas_px{16384, 128};

class FirstPiecesTest : public GpuTest {
 protected:
  FirstPiecesTest() : engine_(device(), {}) {
    engine_.connect(
        {.on_room = [] {},
         .on_failure = [](const std::exception& error) { ADD_FAILURE() << error.what(); }});
  }
  ~FirstPiecesTest() override { engine_.drain(); }

  // Predictions of a frame's build.
  std::vector<int64_t> prepare(const FramePtr& frame) {
    std::vector<int64_t> predicted_ns;
    preparer_ = engine_.preparer();
    frame_ = preparer_->make();
    frame_->take(frame);
    frame_->reserve();
    frame_->prepare(SteadyClock(), {.on_piece = [&](const DoneWork& work) {
                      predicted_ns.push_back(work.predicted_ns);
                    }});
    return predicted_ns;
  }

  // Prediction of the first piece of a display of a frame that was prepared, after its means.
  int64_t firstOf(const FramePtr& frame, DisplaySpec spec) {
    spec.kind = QuiltSpec{.columns = 8, .rows = 1, .size_px = kAtlas_px};
    spec = completeDisplaySpec(spec).value();
    std::vector<SeenSource> sources;
    for (const SourceFormat& source : frame->format.sources) sources.push_back(seenSource(source));
    const auto layout = std::make_shared<const AtlasLayout>(
        makeAtlasLayout(spec, streamDefaults(sources.front().camera.intrinsics,
                                             sources.front().size_px, frame_->measures().stats))
            .value());
    const auto picture = std::make_shared<const TraceJob>(
        makeTraceJob(layout, spec, displayPose(spec, sources.front().camera), sources));
    AtlasOrder order{.picture = picture,
                     .plan = engine_.plan(picture, *frame_),
                     .frames = {frame_.get()},
                     .strips = AtlasStrips(*layout, kAtlas_px.height),
                     .planes = {},
                     .is_for_eyes = false,
                     .picture_key = "wide",
                     .payer = "payer",
                     .note_work = nullptr};
    const std::unique_ptr<Making> making = engine_.begin(std::move(order), [](StripWorkPtr) {});
    const MakingStep step = making->step();
    EXPECT_FALSE(step.is_last);
    making->giveUp();
    return step.predicted_ns;
  }

  WalkEngine engine_;
  std::unique_ptr<FramePreparer> preparer_;
  std::unique_ptr<PreparedFrame> frame_;
};

TEST_F(FirstPiecesTest, ofWalksAreNoLongerThanAPiece) {
  const FramePtr one = test::syntheticFrame(1, {160, 96}, 2);
  for (const FramePtr& frame : {one, twice(*one)}) {
    prepare(frame);
    const int64_t predicted_ns = firstOf(frame, {});
    EXPECT_GT(predicted_ns, 0);
    EXPECT_LE(predicted_ns, kPiece_ns) << frame->format.sources.size() << " sources";
  }
}

TEST_F(FirstPiecesTest, ofBuildsAreNoLongerThanAPiece) {
  const std::vector<int64_t> predicted_ns = prepare(test::syntheticFrame(1, {4096, 96}, 2));
  ASSERT_FALSE(predicted_ns.empty());
  EXPECT_LE(predicted_ns.front(), kPiece_ns);
}

}  // namespace
}  // namespace viewloom::first_pieces_test
