// SPDX-License-Identifier: Apache-2.0
// Px seen through a lens, beside the mean of single rays, each a pinhole of its own that stands
// where the ray passes through the lens.
#include <algorithm>
#include <cmath>
#include <vector>

#include "gpu/rendered_display.h"
#include "support/srgb_transfer.h"
#include "trace/band_parts.h"

namespace viewloom {
namespace {

constexpr uint32_t kWalked = 8;
constexpr double kRadius_m = 0.03;
constexpr double kFocus_m = 1.5;
// Single rays and those of a lens take planes for facets by tolerances of their own.
constexpr double kTolerance_px = 1e-3;

LensSpec walkedLens() {
  return {.aperture_radius_m = kRadius_m,
          .focus_distance_m = kFocus_m,
          .walked_count = kWalked,
          .gathered_count = 0};
}

// The pinhole of one ray: 1 px, whose middle looks along it.
ViewCamera pinholeOf(const View& view, glm::dvec2 px, glm::dvec2 point) {
  const Intrinsics& in = view.camera.intrinsics;
  const glm::dvec2 eye_m = kRadius_m * point;
  ViewCamera camera{.pose = view.camera.pose, .projection = {}};
  camera.pose.position_m += camera.pose.orientation * glm::dvec3(eye_m, 0);
  // Through the px, on the plane in focus: (px - principal) / focal * Z, seen from beside.
  const double focus_m = kFocus_m + view.camera.pose.position_m.z;
  const glm::dvec2 slope =
      (px - in.principal_px) / in.focal_px - glm::dvec2(eye_m.x, -eye_m.y) / focus_m;
  camera.projection =
      Intrinsics{.focal_px = in.focal_px, .principal_px = 0.5 - slope * in.focal_px};
  return camera;
}

class Lens : public RenderedDisplay {
 protected:
  // Of two views beside each other.
  static TraceJob jobOf(uint32_t width_px, uint32_t walked_count, uint32_t gathered_count) {
    DisplaySpec spec{.kind = QuiltSpec{.columns = 2, .rows = 1, .size_px = {width_px, 64}}};
    spec.lens = walkedLens();
    spec.lens->walked_count = walked_count;
    spec.lens->gathered_count = gathered_count;
    const auto completed = completeDisplaySpec(spec);
    EXPECT_TRUE(completed.ok()) << completed.status();
    const Camera camera{.pose = {},
                        .intrinsics = {.focal_px = {300, 300}, .principal_px = {160, 90}}};
    auto layout = makeAtlasLayout(
        *completed, {.source_intrinsics = camera.intrinsics, .source_size_px = kSource_px});
    EXPECT_TRUE(layout.ok()) << layout.status();
    return makeTraceJob(std::make_shared<AtlasLayout>(*std::move(layout)), *completed, Pose{},
                        camera, kSource_px);
  }

  // Of a px of a view, channel by channel, as codes.
  glm::dvec3 meanOfRays(const RenderedAtlas& rays, uint32_t first) {
    glm::dvec3 light(0.0);
    for (uint32_t i = 0; i < kWalked; ++i) {
      const uint32_t color = colorAt(rays, first + i, 0, 0);
      for (int c = 0; c < 3; ++c) light[c] += linearFrom(channelOf(color, c) / 255.0) / kWalked;
    }
    return {std::lround(255 * srgbFrom(light.x)), std::lround(255 * srgbFrom(light.y)),
            std::lround(255 * srgbFrom(light.z))};
  }

  // Codes, root mean square.
  static double differenceOf(const RenderedAtlas& a, const RenderedAtlas& b) {
    double squares = 0;
    for (size_t px = 0; px < a.color.size(); ++px) {
      for (int c = 0; c < 3; ++c) {
        const int difference = channelOf(a.color[px], c) - channelOf(b.color[px], c);
        squares += double(difference) * difference;
      }
    }
    return std::sqrt(squares / double(3 * a.color.size()));
  }

  // The share of channels that differ, of every so many-th px of a view.
  double differingOf(const DisplaySpec& spec, uint32_t view_index) {
    const RenderedAtlas blurred = render(spec);
    const AtlasLayout& layout = *blurred.layout;
    const View& view = layout.views[view_index];
    constexpr uint32_t kStep_px = 11;  // each place of the pattern comes
    constexpr uint32_t kCamerasMax = 1024;
    CamerasSpec cameras{.tile_size_px = {1, 1}, .columns = 32};
    std::vector<SizePx> shown;
    size_t differing = 0;
    size_t count = 0;
    const auto compare = [&] {
      const RenderedAtlas rays = render({.kind = cameras, .tolerance_px = kTolerance_px});
      for (size_t i = 0; i < shown.size(); ++i) {
        const uint32_t got = colorAt(blurred, view_index, shown[i].width, shown[i].height);
        const glm::dvec3 expected = meanOfRays(rays, uint32_t(i) * kWalked);
        for (int c = 0; c < 3; ++c) {
          differing += std::abs(channelOf(got, c) - expected[c]) > kCodeTolerance;
        }
      }
      count += 3 * shown.size();
      shown.clear();
      cameras.cameras.clear();
    };
    for (uint32_t y = 0; y < layout.tile_size_px.height; y += kStep_px) {
      for (uint32_t x = 0; x < layout.tile_size_px.width; x += kStep_px) {
        for (uint32_t i = 0; i < kWalked; ++i) {
          const glm::dvec2 px = glm::dvec2(x, y) + 0.5 + layout.samples[i].px;
          const glm::dvec2 point = layout.lens_points[i * kLensPatternArea_px + y % 8 * 8 + x % 8];
          cameras.cameras.push_back(pinholeOf(view, px, point));
        }
        shown.push_back({x, y});
        if (cameras.cameras.size() + kWalked > kCamerasMax) compare();
      }
    }
    if (!shown.empty()) compare();
    std::cout << differing << " of " << count << " channels differ\n";
    EXPECT_GT(count, 300U);
    return double(differing) / double(count);
  }
};

TEST_F(Lens, showsTheMeanOfItsRaysInAnyViewOfAQuilt) {
  DisplaySpec spec{.kind = QuiltSpec{.columns = 3, .rows = 2, .size_px = {480, 240}},
                   .tolerance_px = kTolerance_px};
  spec.lens = walkedLens();
  EXPECT_LE(differingOf(spec, 0), kTiedShareMax);
  EXPECT_LE(differingOf(spec, 4), kTiedShareMax);
}

TEST_F(Lens, showsTheMeanOfItsRaysWhereAViewIsTurned) {
  ViewCamera camera;
  camera.pose.position_m = {0.05, -0.02, -0.1};
  camera.pose.orientation = glm::angleAxis(0.15, glm::normalize(glm::dvec3(0.3, 1, 0.2)));
  camera.projection = Fov{-0.25, 0.2, 0.15, -0.15};  // all inside the source
  DisplaySpec spec{.kind = CamerasSpec{.cameras = {camera}, .tile_size_px = {160, 120}},
                   .tolerance_px = kTolerance_px};
  spec.lens = walkedLens();
  EXPECT_LE(differingOf(spec, 0), kTiedShareMax);
}

// Half of what the smallest devices bind at once: a wider atlas, or more samples, would not fit.
TEST_F(Lens, keepsNoMoreOfWhatRaysMetThanABufferHolds) {
  const auto metCountOf = [](uint32_t width_px, uint32_t walked_count) {
    return slotShape(jobOf(width_px, walked_count, 32), kBandRowsMax, {}).met_count;
  };
  EXPECT_EQ(metCountOf(480, 64), 64u);
  EXPECT_EQ(metCountOf(16384, 8), 8u);  // 64 MiB
  EXPECT_EQ(metCountOf(16384, 9), 0u);
}

// So that nobody waits at a device for all the rays of another's lens.
TEST_F(Lens, isTracedInPartsOfBoundedWork) {
  const TraceJob job = jobOf(16384, 7, kGatheredSamplesMax);
  constexpr BandRows kRows = {.first_row = 0, .row_count = 64};
  const BandParts parts(job, kRows);
  uint32_t sample = 0;
  uint32_t row = 0;
  for (uint32_t index = 0; index < parts.count(); ++index) {
    const BandPart part = parts.at(index);
    EXPECT_LE(part.ray_count, kPartRays) << index;
    EXPECT_EQ(part.first_sample, part.walks() ? sample : 0);
    EXPECT_EQ(part.first_row, row);
    if (part.walks()) sample = part.end_sample;
    row = part.end_row;
  }
  EXPECT_EQ(sample, 7u) << "two samples a part, one in the last";
  EXPECT_EQ(row, kRows.row_count);
  EXPECT_EQ(parts.count(), 4u + 32u);
  EXPECT_EQ(BandParts(jobOf(480, 8, 32), kRows).count(), 2u) << "the two stages";
}

// The second stage beside as many walked rays, where the source ends in the view: neither blur that
// ends with it nor blocks.
TEST_F(Lens, blursTheEndOfTheSourceIntoTheBackground) {
  ViewCamera camera;
  camera.pose.position_m = {0.1, 0, 0};
  camera.projection = Fov{-0.6, 0.6, 0.4, -0.4};  // wider than the source
  DisplaySpec spec{.kind = CamerasSpec{.cameras = {camera}, .tile_size_px = {320, 200}}};
  spec.outside_fill = OutsideFill::kBackground;
  spec.background_rgb = 0xff00ff;
  spec.lens = walkedLens();
  const RenderedAtlas few = render(spec);
  spec.lens->gathered_count = 32;
  const RenderedAtlas gathered = render(spec);
  spec.lens->walked_count = kWalked + 32;
  spec.lens->gathered_count = 0;
  const RenderedAtlas walked = render(spec);
  const double few_codes = differenceOf(few, walked);
  const double gathered_codes = differenceOf(gathered, walked);
  std::cout << "rms " << few_codes << " of few rays, " << gathered_codes << " codes with more\n";
  EXPECT_LT(gathered_codes, 0.7 * few_codes);
  const auto background_count = std::count(walked.color.begin(), walked.color.end(), 0xffff00ff);
  EXPECT_GT(background_count, walked.color.size() / 10);
  EXPECT_LT(background_count, walked.color.size() / 2);
}

TEST_F(Lens, leavesWhatNoViewCoversBlack) {
  DisplaySpec spec{.kind = QuiltSpec{.columns = 3, .rows = 1, .size_px = {100, 40}}};
  spec.lens = walkedLens();
  spec.lens->gathered_count = 8;
  const RenderedAtlas atlas = render(spec);
  EXPECT_EQ(atlas.layout->padding_right_px, 1u);
  EXPECT_EQ(atlas.color[99], 0xff000000);
}

TEST_F(Lens, leavesDepthAndMaskToTheRayThroughItsMiddle) {
  DisplaySpec spec{.kind = QuiltSpec{.columns = 2, .rows = 1, .size_px = {320, 90}}};
  const RenderedAtlas sharp = render(spec);
  spec.lens = walkedLens();
  const RenderedAtlas blurred = render(spec);
  EXPECT_NE(sharp.color, blurred.color);
  EXPECT_EQ(sharp.mask, blurred.mask);
}

}  // namespace
}  // namespace viewloom
