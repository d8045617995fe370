// SPDX-License-Identifier: Apache-2.0
// Test patterns traced for displays, and the px of single views.
#pragma once

#include <gtest/gtest.h>

#include <vector>

#include "patterns/pattern.h"
#include "support/test_device.h"
#include "walk/offline_renderer.h"

namespace viewloom {

inline constexpr double kPatternFocus_m = 1 / patterns::kFocalPlane_inv_m;

// Fails the test where there is none.
patterns::Pattern patternOf(const patterns::PatternOptions& options);

// One tile of an atlas, which must outlive it.
class ViewPicture {
 public:
  ViewPicture(const RenderedAtlas& atlas, uint32_t view)
      : atlas_(atlas), origin_(atlas.layout->tileOrigin(view)) {}

  SizePx sizePx() const { return atlas_.layout->tile_size_px; }
  int codeAt(uint32_t x, uint32_t y, int channel) const;

 private:
  const RenderedAtlas& atlas_;
  const TileOrigin origin_;
};

class PatternViews : public GpuTest {
 protected:
  void build(patterns::Pattern pattern);
  RenderedAtlas render(DisplaySpec spec);
  // With the focal plane that it has by default.
  RenderedAtlas renderQuilt(uint32_t columns, uint32_t rows, SizePx tile_px, double aspect,
                            double focal_distance_m = 0);
  // Atlas of eyes at these tangents of the focal distance, as large as the source and one below the
  // other. Each eye frames the part of the focal plane that the source sees.
  RenderedAtlas renderEyes(const patterns::Pattern& pattern, const std::vector<double>& tangents);
  SourceStats stats() const { return renderer_.stats().front(); }

 private:
  OfflineRenderer& renderer_ = shared<OfflineRenderer>();
};

}  // namespace viewloom
