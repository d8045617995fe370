// SPDX-License-Identifier: Apache-2.0
// How bands are cut where a row takes long: all px once, and the same picture however they are cut.
#include "trace/band_parts.h"

#include <gtest/gtest.h>

#include <memory>
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
        EXPECT_EQ(part.ends_band, part.end_row == kBand.row_count && part.end_column == width_px);
      }
      for (const uint32_t sample : {0U, 1U}) {
        const std::vector<uint32_t> counts = mirroredCounts(parts, sample, width_px);
        EXPECT_EQ(std::ranges::count(counts, 1U), ptrdiff_t(counts.size()));
      }
    }
  }
}

class PartsTest : public GpuTest {
 protected:
  struct Picture {
    std::vector<uint32_t> color;
    std::vector<float> linear;
    size_t part_count = 0;
    size_t narrow_count = 0;  // of them, those of columns

    bool operator==(const Picture& other) const {
      return color == other.color && linear == other.linear;
    }
  };

  // Two views beside each other, which do not fill whole groups.
  static DisplaySpec specOf(DisplaySpec spec) {
    spec.kind = QuiltSpec{.columns = 2, .rows = 1, .size_px = {420, kBand.row_count}};
    return completeDisplaySpec(spec).value();
  }

  static Picture trace(const Frame& frame, const DisplaySpec& spec, uint64_t ray_count_max) {
    const BuiltFrame built(device(), shared<StructureBuilder>(),
                           std::make_shared<const Frame>(frame));
    std::vector<SeenSource> sources;
    for (const SourceFormat& source : frame.format.sources) sources.push_back(seenSource(source));
    const auto layout = std::make_shared<const AtlasLayout>(
        makeAtlasLayout(spec, streamDefaults(sources.front().camera.intrinsics, kSource_px,
                                             built.structure.stats().front()))
            .value());
    const TraceJob job =
        makeTraceJob(layout, spec, displayPose(spec, sources.front().camera), sources);
    TraceSlot slot(device(), slotShape(job, kBand.row_count, {.linear = true}));
    CommandRecorder recorder(device());
    Timeline timeline(device());
    ViewTracer tracer(device());
    const Commands commands = recorder.begin();
    Picture picture;
    for (BandParts parts(job, kBand); !parts.isOver(); ++picture.part_count) {
      const BandPart part = parts.take(ray_count_max);
      picture.narrow_count += part.end_column - part.first_column < layout->size_px.width;
      tracer.recordPart(commands, built.structure.parts(), job, kBand, part, slot);
    }
    timeline.wait(recorder.submit(timeline));
    picture.color.assign(slot.color().begin(), slot.color().end());
    picture.linear.assign(slot.linear().begin(), slot.linear().end());
    return picture;
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
  const truth::Instant instant(truth::mirrorFloor(0.4), 0);
  const Camera camera{.pose = {}, .intrinsics = {glm::dvec2(120), 0.5 * glm::dvec2(160, 96)}};
  const FramePtr one = truth::frameOf(
      truth::takePicture(instant, camera, {.size_px = kSource_px, .layer_count = 2}), 2);
  const DisplaySpec spec =
      specOf({.reflection = ReflectionSpec{.bounce_count = 2, .sample_count = 2}});
  expectSameInColumns(*one, spec);
  expectSameInColumns(*twice(*one), spec);
}

TEST_F(PartsTest, gatherTheSameInColumns) {
  DisplaySpec spec;
  spec.lens = LensSpec{
      .aperture_radius_m = 0.03, .focus_distance_m = 1.5, .walked_count = 4, .gathered_count = 32};
  expectSameInColumns(*test::syntheticFrame(1, kSource_px, 2), specOf(spec));
}

}  // namespace
}  // namespace viewloom::band_parts_test
