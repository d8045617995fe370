// SPDX-License-Identifier: Apache-2.0
// A test pattern on its whole way: published, traced as the server chooses, watched.
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "e2e/client/with_viewloomd.h"
#include "patterns/view_numbers.h"
#include "support/read_view_number.h"
#include "synthetic/synthetic_wire_frame.h"

namespace viewloom::pattern_stream_test {
namespace {

constexpr uint32_t kColumns = 8, kRows = 3;
constexpr SizePx kTile_px{216, 288};
constexpr SizePx kSource_px{1280, 720};

using PatternStream = test::WithViewloomd;

// Tiles of the quilt's JPEG come as they would to any player.
TEST_F(PatternStream, showsEachViewItsNumber) {
  patterns::PatternOptions options{.kind = patterns::PatternKind::kViewNumbers,
                                   .size_px = kSource_px};
  options.views.count = kColumns * kRows;
  auto pattern = patterns::makePattern(options);
  ASSERT_TRUE(pattern.ok()) << pattern.status();
  WireFrame frame;
  addLayeredSource(pattern->camera, pattern->size_px, std::move(pattern->layers), frame)
      .set_connection_tolerance(pattern->connection_tolerance);

  v1::OpenDisplay open = test::smallQuilt(1);
  v1::QuiltDisplay& quilt = *open.mutable_display()->mutable_quilt();
  quilt.set_columns(kColumns);
  quilt.set_rows(kRows);
  quilt.mutable_size()->set_width(kColumns * kTile_px.width);
  quilt.mutable_size()->set_height(kRows * kTile_px.height);
  std::optional<Atlas> quilt_atlas;
  const auto watcher = watch(open, [&](const Atlas& atlas) { quilt_atlas = atlas; });
  const auto publisher = publish();
  publisher->offer(std::move(frame));
  ASSERT_TRUE(watcher->waitEnded(test::kLong_ns));
  ASSERT_TRUE(quilt_atlas.has_value());
  const auto color = decodePlane(*quilt_atlas, v1::ATLAS_PLANE_COLOR);
  ASSERT_TRUE(color.ok()) << color.status();

  const patterns::PxBox window = patterns::numberPlaces(options)->window;
  const double scale = double{1} * kTile_px.height / kSource_px.height;
  for (uint32_t view = 0; view < kColumns * kRows; ++view) {
    // From the bottom left, row by row upwards.
    const uint32_t left = view % kColumns * kTile_px.width;
    const uint32_t top = (kRows - 1 - view / kColumns) * kTile_px.height;
    const auto number =
        test::readViewNumber(window, kSource_px, kTile_px, scale, [&](uint32_t x, uint32_t y) {
          const size_t px = size_t{top + y} * color->width_px + left + x;
          return color->samples[color->channels * px + 1] > 127;
        });
    EXPECT_EQ(number, std::optional<uint32_t>(view));
  }
}

}  // namespace
}  // namespace viewloom::pattern_stream_test
