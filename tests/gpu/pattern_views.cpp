// SPDX-License-Identifier: Apache-2.0
#include "gpu/pattern_views.h"

#include <string>
#include <utility>

#include "support/test_frames.h"

namespace viewloom {

patterns::Pattern patternOf(const patterns::PatternOptions& options) {
  auto pattern = patterns::makePattern(options);
  EXPECT_TRUE(pattern.ok()) << pattern.status();
  return *std::move(pattern);
}

int ViewPicture::codeAt(uint32_t x, uint32_t y, int channel) const {
  const size_t row = origin_.y_px + y;
  const uint32_t rgba = atlas_.color[row * atlas_.layout->size_px.width + origin_.x_px + x];
  return static_cast<int>(rgba >> (8 * channel) & 0xff);
}

void PatternViews::build(patterns::Pattern pattern) {
  renderer_.build(*test::layeredFrame(1, pattern.camera, pattern.size_px, std::move(pattern.layers),
                                      pattern.connection_tolerance));
}

RenderedAtlas PatternViews::render(DisplaySpec spec) {
  auto completed = completeDisplaySpec(std::move(spec));
  EXPECT_TRUE(completed.ok()) << completed.status();
  auto atlas = renderer_.render(*completed, {}, [](uint32_t, uint32_t) {});
  EXPECT_TRUE(atlas.ok()) << atlas.status();
  return *std::move(atlas);
}

RenderedAtlas PatternViews::renderQuilt(uint32_t columns, uint32_t rows, SizePx tile_px,
                                        double aspect, double focal_distance_m) {
  DisplaySpec spec;
  spec.kind = QuiltSpec{.preset = "",
                        .columns = columns,
                        .rows = rows,
                        .size_px = {columns * tile_px.width, rows * tile_px.height},
                        .aspect = aspect};
  return render(focal_distance_m > 0 ? withFocalDistance(spec, focal_distance_m).value() : spec);
}

RenderedAtlas PatternViews::renderEyes(const patterns::Pattern& pattern,
                                       const std::vector<double>& tangents) {
  CamerasSpec cameras{.cameras = {}, .grid = {}, .tile_size_px = pattern.size_px, .columns = 1};
  for (const double tangent : tangents) {
    Camera camera = pattern.camera;
    camera.pose.position_m.x = kPatternFocus_m * tangent;
    camera.intrinsics.principal_px.x += camera.intrinsics.focal_px.x * tangent;
    cameras.cameras.push_back({camera.pose, camera.intrinsics});
  }
  DisplaySpec spec;
  spec.kind = cameras;
  return render(spec);
}

}  // namespace viewloom
