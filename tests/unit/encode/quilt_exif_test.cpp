// SPDX-License-Identifier: Apache-2.0
// Where a quilt's JPEG says how its views lie; what foreign readers make of it is
// tests/e2e/quilt_metadata_test.py.
#include "encode/quilt_exif.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "encode/band_encoder.h"
#include "unit/encode/picture.h"

namespace viewloom::test::quilt_exif_test {
namespace {

AtlasLayout quiltOf(SizePx size_px) {
  AtlasLayout layout = layoutOf(size_px);
  layout.columns = 11;
  layout.rows = 6;
  layout.aspect = 0.5625;
  layout.suffix = "_qs11x6a0.5625";
  layout.views.resize(66);
  return layout;
}

std::vector<Bytes> encodeBands(const Picture& picture, const AtlasLayout& layout) {
  BytePool pool(4);
  BandEncoder encoder(pool);
  const EncodingSpec encoding;
  const uint32_t band_rows = bandRowCount(encoding);
  std::vector<Bytes> bands;
  for (uint32_t row = 0; row < picture.size_px.height; row += band_rows) {
    const uint32_t row_count = std::min(band_rows, picture.size_px.height - row);
    bands.push_back(*encoder.encode(picture.band(row, row_count), encoding, layout).bytes);
  }
  return bands;
}

TEST(QuiltExif, standsRightBehindSoiAndChangesNothingElse) {
  const Picture picture({333, 300});
  const std::vector<Bytes> plain = encodeBands(picture, layoutOf(picture.size_px));
  std::vector<Bytes> quilt = encodeBands(picture, quiltOf(picture.size_px));
  const std::vector<uint8_t> exif = quiltExif(quiltOf(picture.size_px));
  ASSERT_GT(exif.size(), 4u);
  EXPECT_EQ(exif[0], 0xFF);
  EXPECT_EQ(exif[1], 0xE1);  // APP1
  EXPECT_EQ(size_t{exif[2]} << 8 | exif[3], exif.size() - 2);

  Bytes& first = quilt.front();
  ASSERT_GT(first.size(), exif.size() + 2);
  EXPECT_TRUE(std::equal(exif.begin(), exif.end(), first.begin() + 2));
  first.erase(first.begin() + 2, first.begin() + 2 + static_cast<std::ptrdiff_t>(exif.size()));
  EXPECT_EQ(quilt, plain);
}

TEST(QuiltExif, namesViewsRowsColumnsAspectAndType) {
  const std::vector<uint8_t> exif = quiltExif(quiltOf({333, 300}));
  const std::string text(exif.begin(), exif.end());
  EXPECT_THAT(text, testing::EndsWith(R"({"LKGNumViews":66,"LKGRows":6,"LKGColumns":11,)"
                                      R"("LKGAspect":0.5625,"LKGType":"quilt"})"));
}

TEST(QuiltExif, isNotThereWhereThereIsNoQuilt) {
  EXPECT_TRUE(quiltExif(layoutOf({333, 300})).empty());
}

}  // namespace
}  // namespace viewloom::test::quilt_exif_test
