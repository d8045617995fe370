// SPDX-License-Identifier: Apache-2.0
// Views that look past their source: what geometry says of them, beside the rays of a wall that
// end outside.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "display/views_outside.h"
#include "encode/encoded_band.h"
#include "support/test_device.h"
#include "support/test_frames.h"
#include "walk/offline_renderer.h"

namespace viewloom::views_outside_test {
namespace {

constexpr SizePx kSource_px{320, 200};
constexpr double kFocus_m = 1;

Camera sourceCamera() {
  return {.pose = {}, .intrinsics = {.focal_px = {400, 400}, .principal_px = {160, 100}}};
}

FramePtr wallAt(double z_m) {
  SyntheticLayer wall;
  wall.depth_m.assign(kSource_px.area(), static_cast<float>(z_m));
  wall.color.assign(4 * kSource_px.area(), 200);
  return test::layeredFrame(1, sourceCamera(), kSource_px, {wall});
}

// Px of a view's middle row that do not see the wall: outside; or hidden, where a ray passes beside
// a wall before the focal plane and comes into the source's sight behind it.
uint32_t outsideCount(const RenderedAtlas& atlas, uint32_t view, bool is_near) {
  const TileOrigin origin = atlas.layout->tileOrigin(view);
  const SizePx tile_px = atlas.layout->tile_size_px;
  const size_t row = origin.y_px + tile_px.height / 2;
  uint32_t count = 0;
  for (uint32_t x = 0; x < tile_px.width; ++x) {
    const uint8_t ended = atlas.mask[row * atlas.layout->size_px.width + origin.x_px + x];
    count += ended == static_cast<uint8_t>(RayClass::kOutside) ||
             (is_near && ended == static_cast<uint8_t>(RayClass::kHidden));
  }
  return count;
}

class ViewsOutsideTest : public GpuTest {};

TEST_F(ViewsOutsideTest, areThoseWhoseRaysEndOutside) {
  DisplaySpec spec;
  spec.kind = QuiltSpec{.preset = "",
                        .columns = 9,
                        .rows = 1,
                        .size_px = {9 * kSource_px.width, kSource_px.height},
                        .view_cone_rad = 0.6,
                        .focal_distance_m = kFocus_m};
  const auto completed = completeDisplaySpec(spec);
  ASSERT_TRUE(completed.ok()) << completed.status();
  OfflineRenderer renderer(device());
  for (const double z_m : {0.6, 0.9, 1.0, 1.5, 4.0}) {
    renderer.build(*wallAt(z_m));
    const auto atlas = renderer.render(*completed, {.mask = true}, [](uint32_t, uint32_t) {});
    ASSERT_TRUE(atlas.ok()) << atlas.status();
    const auto shares = outsideShares(*atlas->layout, {}, sourceCamera().intrinsics, kSource_px,
                                      {.far = 1 / z_m, .near = 1 / z_m});
    ASSERT_EQ(shares.size(), 9U);
    for (uint32_t view = 0; view < shares.size(); ++view) {
      // Tiles are as wide and as dense as the source.
      const double expected_px = std::max(shares[view], 0.0) * kSource_px.width;
      EXPECT_NEAR(outsideCount(*atlas, view, z_m < kFocus_m), expected_px, 1)
          << z_m << " m, view " << view;
    }
    const bool is_at_focus = z_m == kFocus_m;
    EXPECT_EQ(viewsOutside(shares).empty(), is_at_focus) << z_m;
    EXPECT_LE(shares[4], 0) << "the source's own view";
  }
}

}  // namespace
}  // namespace viewloom::views_outside_test
