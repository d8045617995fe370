// SPDX-License-Identifier: Apache-2.0
#include "encode/picture_planes.h"

#include <gtest/gtest.h>

#include "support/ycbcr_planes.h"
#include "unit/encode/picture.h"

namespace viewloom::test::picture_planes_test {
namespace {

Bytes samplesOf(const VideoPicture& picture) {
  Bytes samples;
  for (size_t y = 0; y < picture.size_px.height; ++y) {
    const uint8_t* const row = picture.y + y * picture.y_stride_bytes;
    samples.insert(samples.end(), row, row + picture.size_px.width);
  }
  for (const uint8_t* const plane : {picture.cb, picture.cr}) {
    for (size_t y = 0; y < picture.size_px.height / 2; ++y) {
      const uint8_t* const row = plane + y * picture.chroma_stride_bytes;
      samples.insert(samples.end(), row, row + picture.size_px.width / 2);
    }
  }
  return samples;
}

TEST(PicturePlanes, areTheSameFromPlanesAndFromRgbInAnyOrder) {
  BytePool pool(4);
  for (const SizePx size_px : {SizePx{16, 16}, SizePx{34, 150}, SizePx{840, 280}}) {
    const Picture picture(size_px);
    const Bytes planes =
        ycbcrPlanesOf(std::span(picture.rgbx), picture.stride_bytes, size_px, ColorForm::kYcbcr420);
    const BandPixels planar = planarPixels(planes, size_px, ColorForm::kYcbcr420);
    PicturePlanes of_planes(size_px, pool);
    PicturePlanes of_rgb(size_px, pool);
    constexpr uint32_t kRows = 32;
    for (uint32_t row = 0; row < size_px.height; row += kRows) {
      of_planes.put(rowsOf(planar, row, kRows));
    }
    for (uint32_t end = (size_px.height + kRows - 1) / kRows * kRows; end > 0; end -= kRows) {
      const uint32_t row = end - kRows;
      of_rgb.put(picture.band(row, std::min(kRows, size_px.height - row)));
    }
    EXPECT_EQ(samplesOf(of_planes.video()), samplesOf(of_rgb.video())) << size_px.width;
    EXPECT_EQ(of_planes.video().size_px, size_px);
  }
}

TEST(PicturePlanes, takeWholePairsOfRows) {
  BytePool pool(1);
  PicturePlanes planes({16, 16}, pool);
  EXPECT_DEATH(planes.put(Picture({16, 16}).band(1, 2)), "first_row");
  EXPECT_DEATH(planes.put(Picture({16, 16}).band(0, 3)), "row_count");
  EXPECT_DEATH((PicturePlanes({15, 16}, pool)), "width");
}

}  // namespace
}  // namespace viewloom::test::picture_planes_test
