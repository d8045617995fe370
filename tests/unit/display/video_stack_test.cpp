// SPDX-License-Identifier: Apache-2.0
#include "display/video_stack.h"

#include <set>

#include <gtest/gtest.h>

namespace viewloom::test::video_stack_test {
namespace {

VideoStack planned(SizePx view_px, uint32_t view_count) {
  const auto stack = planVideoStack(view_px, view_count);
  EXPECT_TRUE(stack.ok()) << stack.status();
  return stack.value_or(VideoStack{});
}

TEST(VideoStack, putsNeighbouringViewsIntoNeighbouringPictures) {
  const VideoStack portrait = planned({420, 560}, 48);
  EXPECT_EQ(portrait.picture_count, 12u);
  EXPECT_EQ(portrait.pictureSize(), (SizePx{840, 1120}));
  for (uint32_t view = 0; view < 48; ++view) {
    const StackCell cell = portrait.cellOf(view);
    EXPECT_EQ(cell.picture, view % 12);
    EXPECT_EQ(portrait.viewAt(cell), view);
  }
}

// From one pixel to a display of 67 million, with views that are never the same twice.
TEST(VideoStack, givesEachViewACellWithinTheLimits) {
  for (const SizePx view_px : {SizePx{1, 1}, SizePx{16, 16}, SizePx{17, 333}, SizePx{420, 560},
                               SizePx{1024, 1365}, SizePx{2048, 2048}, SizePx{4096, 2176}}) {
    for (const uint32_t count : {1u, 2u, 3u, 7u, 12u, 13u, 45u, 48u, 66u, 100u, 1024u, 2500u}) {
      const VideoStack stack = planned(view_px, count);
      const SizePx picture_px = stack.pictureSize();
      EXPECT_LE(picture_px.width, kVideoPictureMax_px.width);
      EXPECT_LE(picture_px.height, kVideoPictureMax_px.height);
      EXPECT_GE(std::min(picture_px.width, picture_px.height), 16u);
      EXPECT_EQ(picture_px.width % 2 + picture_px.height % 2, 0u);
      EXPECT_EQ(stack.cell_px.width % 2 + stack.cell_px.height % 2, 0u);
      EXPECT_GE(stack.cell_px.width, view_px.width);
      EXPECT_GE(stack.cell_px.height, view_px.height);
      std::set<uint32_t> views;
      uint32_t empty = 0;
      for (uint32_t picture = 0; picture < stack.picture_count; ++picture) {
        for (uint32_t row = 0; row < stack.rows; ++row) {
          for (uint32_t column = 0; column < stack.columns; ++column) {
            const uint32_t view = stack.viewAt({picture, column, row});
            if (view == count)
              ++empty;
            else
              EXPECT_TRUE(views.insert(view).second);
          }
        }
      }
      EXPECT_EQ(views.size(), count);
      EXPECT_LE(empty, count) << "half of a picture at most is empty";
    }
  }
}

TEST(VideoStack, prefersPicturesWithoutEmptyCells) {
  const VideoStack views_45 = planned({420, 560}, 45);
  EXPECT_EQ(views_45.picture_count * views_45.columns * views_45.rows, 45u);
}

TEST(VideoStack, refusesAViewThatNoDecoderTakes) {
  const absl::Status refused = planVideoStack({4096, 4096}, 2).status();
  EXPECT_EQ(refused.code(), absl::StatusCode::kResourceExhausted);
  EXPECT_NE(refused.message().find("a view has 4096x4096 px"), std::string::npos);
}

}  // namespace
}  // namespace viewloom::test::video_stack_test
