// SPDX-License-Identifier: Apache-2.0
// How bands are cut where a row takes long: all px once.
#include "trace/band_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "shared/trace_abi.h"

namespace viewloom::band_parts_test {
namespace {

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

// How many steps each px of the band has mirrored for this sample.
std::vector<uint32_t> mirroredSteps(const std::vector<BandPart>& parts, uint32_t sample,
                                    uint32_t width_px) {
  std::vector<uint32_t> counts(size_t{width_px} * kBand.row_count);
  for (const BandPart& part : parts) {
    if (part.kind != PartKind::kReflect || part.first_sample != sample) continue;
    for (size_t row = part.first_row; row < part.end_row; ++row) {
      for (size_t x = part.first_column; x < part.end_column; ++x) {
        uint32_t& count = counts[row * width_px + x];
        EXPECT_EQ(count, part.first_step) << "step after step";
        count = part.end_step;
      }
    }
  }
  return counts;
}

TEST(BandParts, mirrorEachPxOnceHoweverShortTheyAre) {
  for (const uint32_t width_px : {1U, 63U, 64U, 1000U, 16384U}) {
    for (const uint64_t ray_count_max : {uint64_t{1}, uint64_t{30'000}, kPartRays}) {
      if (width_px > 64 && ray_count_max == 1) continue;  // millions of parts
      SCOPED_TRACE(testing::Message() << width_px << " px, " << ray_count_max << " rays");
      const TraceJob job = wideJob(width_px, 2);
      constexpr uint64_t kSteps = 4 * kReflectionSampleCountMax;
      constexpr uint64_t kPxRays = 2 * kSteps;
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
        const uint32_t steps = part.end_step - part.first_step;
        EXPECT_EQ(part.ray_count,
                  columns * (part.end_row - part.first_row) * kPxRays * steps / kSteps);
        EXPECT_LE(part.ray_count, std::max(max, uint64_t{abi::kTraceGroupSize} * 2));
        EXPECT_EQ(part.settles, columns == width_px && steps == kSteps &&
                                    part.end_row - part.first_row == kBand.row_count);
      }
      for (const uint32_t sample : {0U, 1U}) {
        const std::vector<uint32_t> steps = mirroredSteps(parts, sample, width_px);
        EXPECT_EQ(std::ranges::count(steps, kSteps), ptrdiff_t(steps.size()));
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

}  // namespace
}  // namespace viewloom::band_parts_test
