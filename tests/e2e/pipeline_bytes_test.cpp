// SPDX-License-Identifier: Apache-2.0
// Same frame, same display: same bytes, whatever the order of threads and whoever else watches.
#include <gmock/gmock.h>

#include "e2e/pipeline_fixture.h"

namespace viewloom::test::pipeline_bytes_test {
namespace {

using testing::SizeIs;

const EncodingSpec kAllPlanes{.with_depth = true, .with_mask = true};

class PipelineBytesTest : public PipelineFixture {
 protected:
  static void expectSameBytes(const EncodedAtlas& a, const EncodedAtlas& b) {
    ASSERT_EQ(a.bands.size(), b.bands.size());
    for (size_t i = 0; i < a.bands.size(); ++i) {
      EXPECT_EQ(a.bands[i].plane, b.bands[i].plane);
      EXPECT_EQ(a.bands[i].first_row, b.bands[i].first_row);
      EXPECT_EQ(*a.bands[i].bytes, *b.bands[i].bytes) << "band " << i;
    }
    EXPECT_EQ(a.coverage, b.coverage);
  }
};

TEST_F(PipelineBytesTest, doNotDependOnWhoElseWatchesOrOnTheNumberOfThreads) {
  const DisplaySpec quilt = smallQuilt({400, 300});
  Server alone(device(), {.encode_thread_count = 1, .trace_slot_count = 2});
  const Viewer single = watch(alone, quilt, kAllPlanes);
  alone.offer(syntheticFrame(1));
  ASSERT_THAT(single.subscriber->waitForAtlases(1), SizeIs(1));

  Server crowded(device(), {.encode_thread_count = 4, .trace_slot_count = 5});
  std::vector<Viewer> others;
  others.push_back(watch(crowded, smallQuilt({600, 200})));
  others.push_back(watch(crowded, quilt, {.chroma = Chroma::k444}));
  const Viewer one_of_many = watch(crowded, quilt, kAllPlanes);
  others.push_back(watch(crowded, smallQuilt({100, 70}), kAllPlanes));
  crowded.offer(syntheticFrame(1));
  ASSERT_THAT(one_of_many.subscriber->waitForAtlases(1), SizeIs(1));

  expectSameBytes(*single.subscriber->waitForAtlases(1).front(),
                  *one_of_many.subscriber->waitForAtlases(1).front());
}

// Memory that a wider atlas was traced in before serves narrower ones, too.
TEST_F(PipelineBytesTest, ofALensDoNotDependOnWhatWasTracedBefore) {
  DisplaySpec blurred = smallQuilt({400, 300});
  blurred.lens = LensSpec{
      .aperture_radius_m = 0.02, .focus_distance_m = 2, .walked_count = 4, .gathered_count = 16};
  Server alone(device());
  const Viewer single = watch(alone, blurred);
  alone.offer(syntheticFrame(1));
  ASSERT_THAT(single.subscriber->waitForAtlases(1), SizeIs(1));

  Server shared(device());
  DisplaySpec wide = smallQuilt({1000, 600});
  wide.lens = blurred.lens;
  {
    const Viewer before = watch(shared, wide);
    shared.offer(syntheticFrame(1));
    ASSERT_THAT(before.subscriber->waitForAtlases(1), SizeIs(1));
  }
  const Viewer after = watch(shared, blurred);
  ASSERT_THAT(after.subscriber->waitForAtlases(1), SizeIs(1));
  expectSameBytes(*single.subscriber->waitForAtlases(1).front(),
                  *after.subscriber->waitForAtlases(1).front());
}

// The colour of one display goes to the encoder as planes; beside another chroma, or lossless
// colour, as RGB.
TEST_F(PipelineBytesTest, doNotDependOnTheFormInWhichColourIsEncoded) {
  const FramePtr frame = syntheticFrame(1);
  for (const SizePx size_px : {SizePx{400, 300}, SizePx{414, 301}}) {
    for (const Chroma chroma : {Chroma::k420, Chroma::k444}) {
      const EncodingSpec encoding = {.chroma = chroma, .with_mask = true};
      Server alone(device());
      const Viewer single = watch(alone, smallQuilt(size_px), encoding);
      alone.offer(frame);
      ASSERT_THAT(single.subscriber->waitForAtlases(1), SizeIs(1));

      Server shared(device());
      const Viewer other = watch(shared, smallQuilt(size_px), {.color = BandEncoding::kZstd});
      const Viewer one_of_two = watch(shared, smallQuilt(size_px), encoding);
      shared.offer(frame);
      ASSERT_THAT(one_of_two.subscriber->waitForAtlases(1), SizeIs(1));

      expectSameBytes(*single.subscriber->waitForAtlases(1).front(),
                      *one_of_two.subscriber->waitForAtlases(1).front());
    }
  }
}

TEST_F(PipelineBytesTest, comeInOrderOfSequenceAndFrame) {
  constexpr uint64_t kFrameCount = 12;
  Server server(device(), {.encode_thread_count = 4, .trace_slot_count = 4});
  const Viewer viewer = watch(server, smallQuilt());
  const FramePtr first = syntheticFrame(1);
  for (uint64_t number = 1; number <= kFrameCount; ++number) {
    server.offer(movedFrame(*first, number));
    if (number % 3 == 0) server.reports.waitForReports(number);
  }
  server.reports.waitForReports(kFrameCount);
  server.pipeline.drain();
  uint64_t frame_number = 0;
  uint64_t sequence = 0;
  for (const AtlasPtr& atlas : viewer.subscriber->waitForAtlases(4)) {
    EXPECT_GT(atlas->frame_number, frame_number);
    EXPECT_EQ(atlas->sequence, ++sequence);
    frame_number = atlas->frame_number;
  }
  EXPECT_EQ(frame_number, kFrameCount);
}

}  // namespace
}  // namespace viewloom::test::pipeline_bytes_test
