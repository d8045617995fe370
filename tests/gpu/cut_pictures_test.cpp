// SPDX-License-Identifier: Apache-2.0
// Pictures are the same to the byte, however bands are cut into parts.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

#include "gpu/built_structure.h"
#include "gpu/world_views.h"
#include "picture/display_sources.h"
#include "support/test_device.h"
#include "support/truth/mirror_scenes.h"
#include "support/truth/picture_frame.h"
#include "trace/band_parts.h"
#include "trace/view_tracer.h"

namespace viewloom::cut_pictures_test {
namespace {

constexpr SizePx kSource_px{160, 96};
constexpr uint32_t kRowCount = 64;

class CutPicturesTest : public GpuTest {
 protected:
  struct Picture {
    std::vector<uint32_t> color;
    std::vector<float> linear;
    std::vector<float> depth;
    std::vector<uint8_t> mask;
    Coverage coverage;
    std::vector<uint64_t> means;  // texels of each piece of them
    size_t part_count = 0;
    size_t narrow_count = 0;  // of them, those of columns
    size_t after_count = 0;   // those that merge or settle what others have walked

    bool operator==(const Picture& other) const {
      return color == other.color && linear == other.linear && depth == other.depth &&
             mask == other.mask && coverage == other.coverage;
    }
  };

  // Two views beside each other, which do not fill whole groups.
  static DisplaySpec specOf(DisplaySpec spec) {
    return quiltOf(std::move(spec), 2, {420, kRowCount});
  }

  static DisplaySpec quiltOf(DisplaySpec spec, uint32_t columns, SizePx size_px) {
    spec.kind = QuiltSpec{.columns = columns, .rows = 1, .size_px = size_px};
    return completeDisplaySpec(spec).value();
  }

  static FramePtr mirrors() {
    const truth::Instant instant(truth::mirrorFloor(0.4), 0);
    const Camera camera{.pose = {}, .intrinsics = {glm::dvec2(120), 0.5 * glm::dvec2(160, 96)}};
    return truth::frameOf(
        truth::takePicture(instant, camera, {.size_px = kSource_px, .layer_count = 2}), 2);
  }

  // With means of colour in pieces of so many texels before; 0 = in one go.
  static Picture trace(const Frame& frame, const DisplaySpec& spec, uint64_t ray_count_max,
                       uint64_t texel_count_max = 0) {
    const BuiltFrame built(device(), shared<StructureBuilder>(),
                           std::make_shared<const Frame>(frame));
    std::vector<SeenSource> sources;
    for (const SourceFormat& source : frame.format.sources) sources.push_back(seenSource(source));
    const auto layout = std::make_shared<const AtlasLayout>(
        makeAtlasLayout(spec,
                        streamDefaults(sources.front().camera.intrinsics, sources.front().size_px,
                                       built.structure.stats().front()))
            .value());
    const TraceJob job =
        makeTraceJob(layout, spec, displayPose(spec, sources.front().camera), sources);
    const BandRows band{.first_row = 0, .row_count = layout->size_px.height};
    constexpr TraceOutputs kOutputs{.depth = true, .mask = true, .linear = true};
    TraceSlot slot(device(), slotShape(job, band.row_count, kOutputs));
    CommandRecorder recorder(device());
    Timeline timeline(device());
    ViewTracer tracer(device());
    const Commands commands = recorder.begin();
    Picture picture;
    const auto structures = built.structure.parts();
    while (texel_count_max > 0) {
      const uint64_t texel_count =
          tracer.recordMeans(commands, structures, job, kOutputs, texel_count_max);
      if (texel_count == 0) break;
      picture.means.push_back(texel_count);
    }
    for (BandParts parts = ViewTracer::partsOf(structures, job, band); !parts.isOver();
         ++picture.part_count) {
      const BandPart part = parts.take(ray_count_max);
      picture.narrow_count += part.end_column - part.first_column < layout->size_px.width;
      picture.after_count += part.kind == PartKind::kMerge || part.kind == PartKind::kSettle;
      EXPECT_LE(ViewTracer::rayCount(structures, job, part), part.ray_count);
      tracer.recordPart(commands, structures, job, band, part, slot);
    }
    timeline.wait(recorder.submit(timeline));
    picture.color.assign(slot.color().begin(), slot.color().end());
    picture.linear.assign(slot.linear().begin(), slot.linear().end());
    picture.depth.assign(slot.depth().begin(), slot.depth().end());
    picture.mask.assign(slot.mask().begin(), slot.mask().end());
    picture.coverage = slot.coverage();
    return picture;
  }

  // The same of what is walked alone, with parts after it if there are to be some.
  static void expectSameWalks(const Frame& frame, const DisplaySpec& spec, bool has_after) {
    const Picture whole = trace(frame, spec, kPartRays);
    EXPECT_EQ(whole.narrow_count + whole.after_count, 0u);
    for (const uint64_t ray_count_max : {uint64_t{1}, uint64_t{4500}}) {
      const Picture cut = trace(frame, spec, ray_count_max);
      EXPECT_GT(cut.part_count, whole.part_count) << ray_count_max;
      EXPECT_EQ(cut.after_count > 0, has_after) << ray_count_max;
      EXPECT_TRUE(cut == whole) << ray_count_max;
    }
  }

  static void expectSameInColumns(const Frame& frame, const DisplaySpec& spec) {
    const Picture whole = trace(frame, spec, kPartRays);
    EXPECT_EQ(whole.narrow_count, 0u);
    for (const uint64_t ray_count_max : {uint64_t{1}, uint64_t{1500}}) {
      const Picture cut = trace(frame, spec, ray_count_max);
      EXPECT_GT(cut.narrow_count, kRowCount) << ray_count_max;
      EXPECT_TRUE(cut == whole) << ray_count_max;
    }
  }
};

TEST_F(CutPicturesTest, mirrorTheSameInColumns) {
  const FramePtr one = mirrors();
  const DisplaySpec spec =
      specOf({.reflection = ReflectionSpec{.bounce_count = 2, .sample_count = 2}});
  expectSameInColumns(*one, spec);
  expectSameInColumns(*twice(*one), spec);
}

// Views whose runs lie one after the other in a row of groups, and such whose runs take turns.
TEST_F(CutPicturesTest, walkTheSameInColumns) {
  const FramePtr one = test::syntheticFrame(1, kSource_px, 2);
  for (const uint32_t columns : {2U, 6U}) {
    SCOPED_TRACE(testing::Message() << columns << " views");
    const DisplaySpec spec = quiltOf({}, columns, {7740, 4});
    expectSameWalks(*one, spec, false);
    EXPECT_EQ(trace(*one, spec, 1).narrow_count, 3u * 4);
    expectSameWalks(*twice(*one), spec, true);
    EXPECT_GE(trace(*twice(*one), spec, 1).narrow_count, 2u * 3 * 4 + 7740 / 64 * 4);
  }
}

// Faces of a cube map answer for one source, and some of them see nothing. A row of this width asks
// its six structures for more rays than a part may have.
TEST_F(CutPicturesTest, walkTheSameInFacesOfACubeMap) {
  expectSameWalks(*test::syntheticCubeFrame(1), quiltOf({}, 2, {1680, 16}), true);
}

// Several samples are blended, and rays of a lens merged after those through its middle.
TEST_F(CutPicturesTest, walkTheSameSampleBySample) {
  const FramePtr one = test::syntheticFrame(1, kSource_px, 2);
  DisplaySpec filtered;
  filtered.filter = {.sample_count = 4, .width = 2};
  expectSameWalks(*one, specOf(filtered), true);
  expectSameWalks(*twice(*one), specOf(filtered), true);
  DisplaySpec seen_through;
  seen_through.lens = LensSpec{
      .aperture_radius_m = 0.03, .focus_distance_m = 1.5, .walked_count = 4, .gathered_count = 0};
  expectSameWalks(*one, specOf(seen_through), true);
  expectSameWalks(*twice(*one), specOf(seen_through), true);
}

// The least that is made at once is a row of strips, which a wide source has shorter ones of. Px of
// this display see several texels, so that means are taken at all.
TEST_F(CutPicturesTest, takeMeansOfWideSourcesInShortPieces) {
  const FramePtr wide = test::syntheticFrame(1, {16384, 64}, 2);
  const DisplaySpec coarse = quiltOf({}, 2, {420, 16});
  const Picture whole = trace(*wide, coarse, kPartRays);
  const Picture cut = trace(*wide, coarse, kPartRays, 1);
  ASSERT_FALSE(cut.means.empty());
  EXPECT_LE(std::ranges::max(cut.means), uint64_t{1} << 18);
  EXPECT_EQ(std::accumulate(cut.means.begin(), cut.means.end(), uint64_t{0}),
            uint64_t{16384} * 64 * 2);
  EXPECT_TRUE(cut == whole);
}

TEST_F(CutPicturesTest, gatherTheSameInColumns) {
  DisplaySpec spec;
  spec.lens = LensSpec{
      .aperture_radius_m = 0.03, .focus_distance_m = 1.5, .walked_count = 4, .gathered_count = 32};
  expectSameInColumns(*test::syntheticFrame(1, kSource_px, 2), specOf(spec));
}

}  // namespace
}  // namespace viewloom::cut_pictures_test
