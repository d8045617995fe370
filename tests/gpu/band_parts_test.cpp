// SPDX-License-Identifier: Apache-2.0
// How bands are cut where a row takes long: all px once, and the same picture however they are cut.
#include "trace/band_parts.h"

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
#include "trace/view_tracer.h"

namespace viewloom::band_parts_test {
namespace {

constexpr SizePx kSource_px{160, 96};
constexpr BandRows kBand{.first_row = 0, .row_count = 64};

TraceJob wideJob(uint32_t width_px, uint32_t walk_count) {
  auto layout = std::make_shared<AtlasLayout>();
  layout->size_px = {width_px, kBand.row_count};
  layout->tile_size_px = layout->size_px;
  TraceJob job;
  job.layout = layout;
  job.walk_count = walk_count;
  job.sample_count = 2;
  job.has_mirrors = true;
  job.reflection = ReflectionSpec{.bounce_count = 4, .sample_count = kReflectionSampleCountMax};
  return job;
}

// How often each px of the band mirrors for this sample.
std::vector<uint32_t> mirroredCounts(const std::vector<BandPart>& parts, uint32_t sample,
                                     uint32_t width_px) {
  std::vector<uint32_t> counts(size_t{width_px} * kBand.row_count);
  for (const BandPart& part : parts) {
    if (part.kind != PartKind::kReflect || part.first_sample != sample) continue;
    for (size_t row = part.first_row; row < part.end_row; ++row) {
      for (size_t x = part.first_column; x < part.end_column; ++x) ++counts[row * width_px + x];
    }
  }
  return counts;
}

TEST(BandParts, mirrorEachPxOnceHoweverShortTheyAre) {
  for (const uint32_t width_px : {1U, 63U, 64U, 1000U, 16384U}) {
    for (const uint64_t ray_count_max : {uint64_t{1}, uint64_t{30'000}, kPartRays}) {
      SCOPED_TRACE(testing::Message() << width_px << " px, " << ray_count_max << " rays");
      const TraceJob job = wideJob(width_px, 2);
      const uint64_t px_rays = uint64_t{2} * 4 * kReflectionSampleCountMax;
      std::vector<BandPart> parts;
      for (BandParts band(job, kBand); !band.isOver();) {
        // Their cost turns out otherwise on the way.
        const uint64_t max = parts.size() % 5 == 4 ? 2 * ray_count_max : ray_count_max;
        parts.push_back(band.take(max));
        const BandPart& part = parts.back();
        EXPECT_EQ(part.is_last, band.isOver());
        EXPECT_EQ(part.first_column % abi::kTraceGroupSize, 0u);
        if (part.kind != PartKind::kReflect) continue;
        const uint32_t columns = part.end_column - part.first_column;
        EXPECT_TRUE(columns == width_px || part.end_row == part.first_row + 1);
        EXPECT_EQ(part.ray_count, columns * (part.end_row - part.first_row) * px_rays);
        EXPECT_LE(part.ray_count, std::max(max, abi::kTraceGroupSize * px_rays));
        EXPECT_EQ(part.settles,
                  columns == width_px && part.end_row - part.first_row == kBand.row_count);
      }
      for (const uint32_t sample : {0U, 1U}) {
        const std::vector<uint32_t> counts = mirroredCounts(parts, sample, width_px);
        EXPECT_EQ(std::ranges::count(counts, 1U), ptrdiff_t(counts.size()));
      }
    }
  }
}

// How often parts have walked, merged and settled each px for a sample.
struct Walked {
  Walked(uint32_t walk_count, uint32_t width_px, uint32_t rows)
      : width(width_px),
        walked(walk_count, std::vector<uint32_t>(size_t{width_px} * rows)),
        merged(size_t{width_px} * rows),
        settled(rows) {}

  void add(const BandPart& part) {
    const bool settles = part.settles || part.kind == PartKind::kSettle;
    for (uint32_t row = part.first_row; row < part.end_row; ++row) {
      settled[row] += settles;
      for (size_t x = part.first_column; x < part.end_column; ++x) {
        for (uint32_t walk = part.first_walk; part.walks() && walk < part.end_walk; ++walk) {
          ++walked[walk][row * width + x];
        }
        merged[row * width + x] += part.merges;
        if (part.merges) merges_early |= walked.back()[row * width + x] == 0;
      }
    }
  }

  void expectOnce(bool is_merged) const {
    const auto expectOnes = [](const std::vector<uint32_t>& counts) {
      EXPECT_EQ(std::ranges::count(counts, 1U), ptrdiff_t(counts.size()));
    };
    for (const std::vector<uint32_t>& of_walk : walked) expectOnes(of_walk);
    if (is_merged) expectOnes(merged);
    expectOnes(settled);
    EXPECT_FALSE(merges_early && is_merged);
  }

  size_t width;
  std::vector<std::vector<uint32_t>> walked;  // [walk][px]
  std::vector<uint32_t> merged;
  std::vector<uint32_t> settled;  // by row
  bool merges_early = false;
};

// A row of a wide atlas takes long, in each of many structures.
TEST(BandParts, walkEachPxOnceHoweverShortTheyAre) {
  constexpr BandRows kRows{.first_row = 0, .row_count = 3};
  for (const uint32_t width_px : {1U, 63U, 5000U, 16384U}) {
    for (const uint32_t walk_count : {1U, 2U, 48U}) {
      for (const uint64_t ray_count_max : {uint64_t{1}, uint64_t{5000}, uint64_t{100'000}}) {
        SCOPED_TRACE(testing::Message() << width_px << " px, " << walk_count << " walks, "
                                        << ray_count_max << " rays");
        TraceJob job = wideJob(width_px, walk_count);
        job.reflection.reset();
        std::vector<Walked> samples(job.sample_count, Walked(walk_count, width_px, 3));
        size_t count = 0;
        for (BandParts band(job, kRows); !band.isOver(); ++count) {
          const uint64_t max = count % 5 == 4 ? 2 * ray_count_max : ray_count_max;
          const BandPart part = band.take(max);
          const uint32_t least_px = part.walks() ? kWalkColumns_px : abi::kTraceGroupSize;
          const uint64_t least = part.kind == PartKind::kSettle  ? width_px
                                 : part.kind == PartKind::kMerge ? least_px * walk_count
                                                                 : least_px;
          EXPECT_LE(part.ray_count, std::max(max, least));
          EXPECT_EQ(part.is_last, band.isOver());
          const uint32_t end = part.walks() ? part.end_sample : part.first_sample + 1;
          for (uint32_t i = part.first_sample; i < end; ++i) samples[i].add(part);
        }
        for (const Walked& sample : samples) sample.expectOnce(walk_count > 1);
      }
    }
  }
}

class PartsTest : public GpuTest {
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
    return quiltOf(std::move(spec), 2, {420, kBand.row_count});
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
      EXPECT_GT(cut.narrow_count, kBand.row_count) << ray_count_max;
      EXPECT_TRUE(cut == whole) << ray_count_max;
    }
  }
};

TEST_F(PartsTest, mirrorTheSameInColumns) {
  const FramePtr one = mirrors();
  const DisplaySpec spec =
      specOf({.reflection = ReflectionSpec{.bounce_count = 2, .sample_count = 2}});
  expectSameInColumns(*one, spec);
  expectSameInColumns(*twice(*one), spec);
}

// Views whose runs lie one after the other in a row of groups, and such whose runs take turns.
TEST_F(PartsTest, walkTheSameInColumns) {
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

// Faces of a cube map answer for one source, and some of them see nothing.
TEST_F(PartsTest, walkTheSameInFacesOfACubeMap) {
  expectSameWalks(*test::syntheticCubeFrame(1), specOf({}), true);
}

// Several samples are blended, and rays of a lens merged after those through its middle.
TEST_F(PartsTest, walkTheSameSampleBySample) {
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

// The least that is made at once is a row of strips, which a wide source has shorter ones of.
TEST_F(PartsTest, takeMeansOfWideSourcesInShortPieces) {
  const FramePtr wide = test::syntheticFrame(1, {16384, 64}, 2);
  const Picture whole = trace(*wide, specOf({}), kPartRays);
  const Picture cut = trace(*wide, specOf({}), kPartRays, 1);
  ASSERT_FALSE(cut.means.empty());
  EXPECT_LE(std::ranges::max(cut.means), uint64_t{1} << 18);
  EXPECT_EQ(std::accumulate(cut.means.begin(), cut.means.end(), uint64_t{0}),
            uint64_t{16384} * 64 * 2);
  EXPECT_TRUE(cut == whole);
}

TEST_F(PartsTest, gatherTheSameInColumns) {
  DisplaySpec spec;
  spec.lens = LensSpec{
      .aperture_radius_m = 0.03, .focus_distance_m = 1.5, .walked_count = 4, .gathered_count = 32};
  expectSameInColumns(*test::syntheticFrame(1, kSource_px, 2), specOf(spec));
}

}  // namespace
}  // namespace viewloom::band_parts_test
