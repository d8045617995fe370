// SPDX-License-Identifier: Apache-2.0
// Px seen through a lens, beside the mean of single rays, each a pinhole of its own that stands
// where the ray passes through the lens.
#pragma once

#include <cmath>
#include <cstdlib>
#include <iostream>
#include <vector>

#include "gpu/rendered_display.h"
#include "support/srgb_transfer.h"

namespace viewloom {

inline constexpr uint32_t kWalked = 8;
// Single rays and those of a lens take planes for facets by tolerances of their own.
inline constexpr double kTolerance_px = 1e-3;

inline LensSpec walkedLens() {
  return {.aperture_radius_m = 0.03,
          .focus_distance_m = 1.5,
          .walked_count = kWalked,
          .gathered_count = 0};
}

// The pinhole of one ray: 1 px, whose middle looks along it.
inline ViewCamera pinholeOf(const LensSpec& lens, const View& view, glm::dvec2 px,
                            glm::dvec2 point) {
  const Intrinsics& in = view.camera.intrinsics;
  const glm::dvec2 eye_m = lens.aperture_radius_m * point;
  ViewCamera camera{.pose = view.camera.pose, .projection = {}};
  camera.pose.position_m += camera.pose.orientation * glm::dvec3(eye_m, 0);
  // Through the px, on the plane in focus: (px - principal) / focal * Z, seen from beside.
  const double focus_m = *lens.focus_distance_m + view.camera.pose.position_m.z;
  const glm::dvec2 slope =
      (px - in.principal_px) / in.focal_px - glm::dvec2(eye_m.x, -eye_m.y) / focus_m;
  camera.projection =
      Intrinsics{.focal_px = in.focal_px, .principal_px = 0.5 - slope * in.focal_px};
  return camera;
}

class ThroughLens : public RenderedDisplay {
 protected:
  // Mean for a px of a view, channel by channel, as codes.
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
      const RenderedAtlas rays =
          render({.kind = cameras, .tolerance_px = kTolerance_px, .reflection = spec.reflection});
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
          cameras.cameras.push_back(pinholeOf(*spec.lens, view, px, point));
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

}  // namespace viewloom
